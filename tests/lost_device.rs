//! A device that is lost in the middle of a run: what was judged before stays, and the report says what was under way.

use lightmeter::arithmetic::profile::WGSL;
use lightmeter::cases::blend::Samples;
use lightmeter::filter::Filter;
use lightmeter::run::{Options, Progress, run};
use lightmeter::select::Shard;
use lightmeter::subject::Subject;
use lightmeter_gpu::{Shaders, vulkan_adapters};
use lightmeter_scene::target::TargetFormat;

/// Loses the devices when a group begins.
struct LoseAt<F> {
    group: &'static str,
    lose: F,
}

impl<F: Fn()> Progress for LoseAt<F> {
    fn start(&mut self, _cases: u64) {}
    fn group(&mut self, id: &str) {
        if id == self.group {
            (self.lose)();
        }
    }
    fn advance(&mut self, _cases: u64) {}
}

#[test]
fn a_lost_device_ends_the_run_and_keeps_what_was_judged() {
    let adapters = vulkan_adapters();
    let adapter = adapters.first().expect("no Vulkan driver is here: `./x test` installs lavapipe");
    let mut subject = Subject::open(adapter).expect("the adapter gives a device");
    let shaders = Shaders::built_in().expect("the built-in shaders are valid");
    let lose = subject.blend_unit(&shaders).expect("a blend unit").expect("a device has one").breaker();
    let options = Options {
        filter: Filter::new(&["blend/{min,max,write-mask}"]).expect("the glob is valid"),
        cases: 64,
        seed: 1,
        shard: Shard::WHOLE,
        targets: vec![TargetFormat::Rgba8Unorm],
        samples: Samples::default(),
        again: false,
        profile: &WGSL,
        shaders,
        rerun: String::new(),
    };
    let report = run(&mut [subject], &options, &mut LoseAt { group: "blend/max", lose }).expect("there is a report");
    let interrupted = report.interrupted.as_ref().expect("the run was interrupted");
    assert!(
        interrupted.under_way.contains("blend/max") && interrupted.under_way.contains("rgba8unorm"),
        "{interrupted:?}"
    );
    assert!(interrupted.message.contains("the device failed"), "{interrupted:?}");
    let judged: Vec<&str> = report.groups.iter().map(|group| group.id.as_str()).collect();
    assert!(judged.contains(&"blend/min"), "{judged:?}");
    assert!(!judged.contains(&"blend/write-mask"), "{judged:?}");
    assert!(!report.is_success());
}
