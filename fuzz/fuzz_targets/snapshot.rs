//! See `bspcsg_fuzz::targets::snapshot`.
#![no_main]

libfuzzer_sys::fuzz_target!(
    init: bspcsg_fuzz::seeds::write_if_asked("snapshot"),
    |data: &[u8]| bspcsg_fuzz::targets::snapshot(data)
);
