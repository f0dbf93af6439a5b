//! The techniques that `bench` measures against each other, judged as what the catalogue has.

use lightmeter::bench::techniques;
use lightmeter::document::event::Silent;
use lightmeter::options::Options;
use lightmeter::run::run_selection;
use lightmeter::select::Member;
use lightmeter::selection::Selection;
use lightmeter::subject_gpu::code_of;
use lightmeter_gpu::Shaders;
use lightmeter_gpu::compose::Technique;
use lightmeter_tests::techniques::drawn_by;
use std::sync::Arc;

#[test]
fn every_technique_computes_what_it_says() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let mut subjects = lightmeter::adapters::open(&[]).expect("there is an adapter");
    let options = Options::new(code_of(None).expect("the built-in shaders are valid"));
    let members: Arc<[Member]> = techniques::formulas().into();
    let selection = Selection::of_formulas(members.clone(), &options);
    let report = run_selection(&selection, &mut subjects, &options, &mut Silent).expect("the device does not fail");
    let told: Vec<String> = report.failures.iter().map(|failure| failure.id.clone()).collect();
    assert!(report.is_success(), "{told:?}");
    for member in members.iter() {
        let asked = report.groups.iter().filter(|group| group.id == member.spec.group());
        let passed: Vec<u64> = asked.map(|group| group.totals.passed).collect();
        assert!(
            passed.len() >= 2 && passed.iter().all(|&passed| passed > options.cases / 2),
            "{}: {passed:?}",
            member.spec.id
        );
    }
}

#[test]
#[ignore = "long: ./x campaign long"]
fn every_technique_of_drawing_is_right_where_it_is_exact() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let subject = lightmeter::adapters::open(&[]).expect("there is an adapter").swap_remove(0);
    let shaders = Shaders::built_in().expect("the built-in shaders are valid");
    for technique in Technique::ALL {
        let finding = drawn_by(technique, &subject, &shaders).expect("the device does not fail");
        assert_eq!(finding.departure, None);
        assert!(finding.images >= 5, "{}: {} images", technique.name(), finding.images);
    }
}
