//! See `bspcsg_fuzz::targets::extract`.
#![no_main]

libfuzzer_sys::fuzz_target!(
    init: bspcsg_fuzz::seeds::write_if_asked("extract"),
    |data: &[u8]| bspcsg_fuzz::targets::extract(data)
);
