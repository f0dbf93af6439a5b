//! What is right stays right in every form that a shader compiler may put it in.

use lightmeter::adapters;
use lightmeter::document::event::Silent;
use lightmeter::filter::Filter;
use lightmeter::options::Options;
use lightmeter::run::run_selection;
use lightmeter::selection::Selection;
use lightmeter::subject_gpu::code;
use lightmeter_gpu::Shaders;
use lightmeter_tests::callers::callers;
use lightmeter_tests::forms::{FORMS, in_form};

/// Every formula but the many states of the blend unit, which are a product and a sum each.
const FORMULAS: [&str; 14] = [
    "interpolation",
    "color",
    "vector",
    "lighting",
    "attenuation",
    "fog",
    "depth",
    "blend/mode-*",
    "blend/saturate-source-only",
    "blend/over*",
    "blend/*opacity*",
    "blend/unpremultiply*",
    "blend/subtract-*",
    "blend/alpha-clamped",
];
/// Random cases of each, beside the hard ones.
const CASES: u64 = 256;

#[test]
fn what_is_right_passes_in_every_legal_form() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let mut subject = adapters::open(&[]).expect("there is an adapter").swap_remove(0);
    let shaders = Shaders::built_in().expect("the built-in shaders are valid");
    let filter = Filter::new(&FORMULAS.map(String::from)).expect("the globs are valid");
    let mut wrong = vec![];
    for form in &FORMS {
        let (put, functions) = in_form(&shaders, form).unwrap_or_else(|error| panic!("{}: {error}", form.name));
        let judged = callers(&put, functions.iter().map(String::as_str));
        let options = Options { filter: filter.clone(), cases: CASES, ..Options::new(code(put)) };
        let mut selection = Selection::of(&options);
        // The built-in functions that they are of may be put another way too.
        selection.deviations.clear();
        let catalogue = selection.catalogue.clone();
        selection.formulas.retain(|chosen| judged.contains(catalogue[chosen.member].spec.function));
        assert!(!selection.formulas.is_empty(), "{}: in no formula", form.name);
        let report = run_selection(&selection, std::slice::from_mut(&mut subject), &options, &mut Silent)
            .expect("the device does not fail");
        let failing = report.groups.iter().filter(|group| group.totals.failed > 0 || !group.problems.is_empty());
        wrong.extend(failing.map(|group| {
            let problem = group.problem().unwrap_or_default();
            format!("{}: {} in {}, {} failed; {problem}", form.name, group.id, group.stage, group.totals.failed)
        }));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
