//! libFuzzer on one reader of foreign input: that which `LIGHTMETER_READER` names. `./x fuzz` builds and starts it.

#![no_main]

use lightmeter_tests::readers::{READERS, InputReader};
use std::sync::LazyLock;

static READER: LazyLock<&InputReader> = LazyLock::new(|| {
    let name = std::env::var("LIGHTMETER_READER").unwrap_or_default();
    READERS.iter().find(|reader| reader.name == name).unwrap_or_else(|| panic!("there is no reader `{name}`"))
});

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if bytes.len() <= READER.most {
        (READER.read)(bytes);
    }
});
