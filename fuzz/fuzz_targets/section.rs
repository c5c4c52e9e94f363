//! See `bspcsg_fuzz::targets::section`.
#![no_main]

libfuzzer_sys::fuzz_target!(
    init: bspcsg_fuzz::seeds::write_if_asked("section"),
    |data: &[u8]| bspcsg_fuzz::targets::section(data)
);
