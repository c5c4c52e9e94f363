//! See `bspcsg_fuzz::targets::evaluate`.
#![no_main]

libfuzzer_sys::fuzz_target!(
    init: bspcsg_fuzz::seeds::write_if_asked("evaluate"),
    |data: &[u8]| bspcsg_fuzz::targets::evaluate(data)
);
