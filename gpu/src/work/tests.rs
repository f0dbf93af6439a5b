//! What a device gives of a description is what it gives of the same after it was written as JSON and read again.

use super::{Resources, Submission};
use crate::adapters::native_adapters;
use crate::device::{Executor, Gpu};
use lightmeter_scene::target::SENTINEL;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;

/// The first adapter's device.
pub(crate) fn device() -> Gpu {
    let adapters = native_adapters();
    let adapter = adapters.first().expect("no Vulkan driver is here: `./x test` installs lavapipe");
    adapter.open().unwrap_or_else(|error| panic!("{error}"))
}

/// The words that come back of a description, once it is seen that they are the same of the one that was read from JSON.
pub(crate) fn words_by_json(gpu: &Gpu, resources: &Resources, work: &Submission) -> Vec<u32> {
    let run = |resources: &Resources, work: &Submission| {
        let mut executor = Executor::default();
        executor.make(gpu, resources, "described").unwrap_or_else(|error| panic!("{error}"));
        executor.submit(gpu, work).wait(gpu).unwrap_or_else(|error| panic!("{error}"))
    };
    let words = run(resources, work);
    let read = run(&by_json(resources), &by_json(work));
    let first_other = words.iter().zip(&read).position(|(word, read)| word != read);
    assert_eq!(
        (first_other, words.len()),
        (None, read.len()),
        "the place of the first other word, and how many there are"
    );
    let first = words.first().expect("something comes back");
    assert!(words.iter().any(|word| word != first && *word != SENTINEL), "nothing is drawn or computed");
    words
}

fn by_json<T: Serialize + DeserializeOwned + PartialEq + Debug>(described: &T) -> T {
    let json = serde_json::to_string(described).expect("a description can be written");
    let read = serde_json::from_str(&json).unwrap_or_else(|error| panic!("{error}: {json}"));
    assert!(read == *described, "another description is read than was written: {json}");
    read
}
