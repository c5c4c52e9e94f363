//! See `bspcsg_fuzz::targets::program`.
#![no_main]

libfuzzer_sys::fuzz_target!(
    init: bspcsg_fuzz::seeds::write_if_asked("program"),
    |data: &[u8]| bspcsg_fuzz::targets::program(data)
);
