//! See `bspcsg_fuzz::targets::import`.
#![no_main]

libfuzzer_sys::fuzz_target!(
    init: bspcsg_fuzz::seeds::write_if_asked("import"),
    |data: &[u8]| bspcsg_fuzz::targets::import(data)
);
