#![no_main]

use libfuzzer_sys::fuzz_target;
use meshgauge_fuzz::{SURFACES, score_one_of};

fuzz_target!(|data: &[u8]| score_one_of(SURFACES, data));
