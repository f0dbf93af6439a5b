//! Hard cases on both sides: every stable form keeps its claim and every naive form fails as it is said to, on every Vulkan
//! adapter there is; a stable form that is the naive one is found out.

use lightmeter::arithmetic::Accept;
use lightmeter::arithmetic::profile::WGSL;
use lightmeter::cases::{Domain, FAMILIES, Formula, Kind, Reader, Spec, Visitor, Wanted, Writer, visit};
use lightmeter::device::Code;
use lightmeter::document::event::Silent;
use lightmeter::document::show::{Conditioning, FormStanding};
use lightmeter::filter::Filter;
use lightmeter::options::Options;
use lightmeter::run::run;
use lightmeter::select::{CaseRef, Member, catalogue};
use lightmeter::stability::{self, roundings};
use lightmeter::subject::Subject;
use lightmeter::subject_gpu::{code_of, open_device};
use lightmeter_gpu::{Adapter, FILES};
use lightmeter_reference::Real as _;
use lightmeter_tests::exact::{self, Exact};
use lightmeter_tests::place::folder;
use std::collections::{BTreeMap, BTreeSet};

/// Formulas whose naive forms compute something else: a model that is wrong there, or no rule where one is needed.
const OTHERS: [&str; 10] = [
    "color/srgb-encode-component",
    "vector/halfway",
    "vector/reflect-any-normal",
    "vector/interpolated-normal-guarded",
    "lighting/phong-gated",
    "lighting/phong-shading",
    "lighting/cosine-power-by-chord",
    "lighting/blinn-stable",
    "attenuation/spot-exponent-by-chord",
    "blend/unpremultiply-guarded",
];

fn stable(catalogue: &[Member]) -> impl Iterator<Item = &Member> {
    catalogue.iter().filter(|member| member.spec.stable.is_some())
}

fn options(code: Code) -> Options {
    Options { filter: Filter::new(&["*/*/hard"]).expect("a glob"), cases: 1, targets: vec![], ..Options::new(code) }
}

fn subjects() -> Vec<Subject> {
    let adapters = lightmeter_gpu::native_adapters();
    assert!(!adapters.is_empty(), "no Vulkan driver is here: `./x test` installs lavapipe");
    let open = |adapter: &Adapter| open_device(adapter).expect("the adapter gives a device");
    adapters.iter().map(open).collect()
}

#[test]
fn there_are_sixty_hard_cases_on_both_sides_over_all_families() {
    let catalogue = catalogue();
    let cases: Vec<(&Member, usize)> = stable(&catalogue)
        .flat_map(|member| {
            let both = |place: &usize| member.spec.hard[*place].naive.is_some();
            (0..member.spec.hard.len()).filter(both).map(move |place| (member, place))
        })
        .collect();
    assert!(cases.len() >= 60, "{} cases", cases.len());
    let families: BTreeSet<&str> = cases.iter().map(|(member, _)| member.spec.family()).collect();
    assert_eq!(families, FAMILIES.into_iter().collect());
    let stable: Vec<&str> = stable(&catalogue).map(|member| member.spec.id.as_str()).collect();
    for id in stable {
        assert!(cases.iter().any(|(member, _)| member.spec.id == id), "{id} claims to be stable, and no case shows it");
    }
}

#[test]
fn a_naive_form_takes_and_gives_what_the_stable_one_does() {
    let catalogue = catalogue();
    let shapes = |spec: &Spec| {
        let inputs: Vec<_> = spec.inputs.iter().map(|input| (input.name, input.shape)).collect();
        (inputs, spec.outputs.iter().map(|output| output.shape).collect::<Vec<_>>())
    };
    for member in stable(&catalogue) {
        for naive in member.spec.hard.iter().filter_map(|hard| hard.naive) {
            let rival = catalogue.iter().find(|other| other.spec.id == naive.formula);
            let rival = rival.unwrap_or_else(|| panic!("{}: no formula `{}`", member.spec.id, naive.formula));
            assert_eq!(
                shapes(&member.spec).0.len(),
                shapes(&rival.spec).0.len(),
                "{} and {}",
                member.spec.id,
                rival.spec.id
            );
            for (own, other) in member.spec.inputs.iter().zip(rival.spec.inputs) {
                assert_eq!(own.shape, other.shape, "{} of {} and {}", own.name, member.spec.id, rival.spec.id);
            }
            assert_eq!(shapes(&member.spec).1, shapes(&rival.spec).1, "{} and {}", member.spec.id, rival.spec.id);
            assert!(naive.at_least > member.spec.stable.expect("a stable form").bound, "{}: {naive:?}", member.spec.id);
        }
    }
}

#[test]
fn cases_near_a_hard_one_are_a_few_ulp_away_on_both_sides() {
    let key = |x: f32| {
        let bits = i64::from(x.to_bits() & 0x7fff_ffff);
        if x.is_sign_negative() { -bits } else { bits }
    };
    let (mut below, mut above) = (0, 0);
    for member in catalogue().iter().filter(|member| member.near() > 0) {
        for (place, hard) in member.spec.hard.iter().enumerate() {
            let row = |case| {
                let mut row = vec![];
                member.inputs(case, 1, &mut row);
                row
            };
            let at = row(CaseRef::Hard(place));
            let mut distinct = BTreeSet::new();
            for k in 0..member.near() {
                let near = row(CaseRef::Near(place, k));
                distinct.insert(near.iter().map(|x| x.to_bits()).collect::<Vec<_>>());
                for (input, range) in
                    member.spec.inputs.iter().map(|i| (i, member.spec.place(i.name).expect("its own")))
                {
                    let is_given = hard.inputs.iter().any(|(name, _)| *name == input.name);
                    for (a, b) in at[range.clone()].iter().zip(&near[range]) {
                        assert!(
                            is_given || a.to_bits() == b.to_bits(),
                            "{} {}: {}",
                            member.spec.id,
                            hard.name,
                            input.name
                        );
                        let step = key(*b) - key(*a);
                        let is_least = *a == 0.0 && b.abs() == f32::MIN_POSITIVE;
                        assert!(step.abs() <= 3 || is_least, "{} {}: {a:e} to {b:e}", member.spec.id, hard.name);
                        below += u64::from(step < 0);
                        above += u64::from(step > 0);
                    }
                }
            }
            let is_moved = distinct.len() > 1;
            let is_continuous = |name: &str| {
                let input = member.spec.inputs.iter().find(|input| input.name == name).expect("its own");
                !matches!(input.domain, Domain::Whole(..) | Domain::Halves(..) | Domain::Pixel)
            };
            let is_fraction = |values: &[f32]| values.iter().any(|x| x.fract() != 0.0);
            let could_move = hard.inputs.iter().any(|(name, values)| is_continuous(name) && is_fraction(values));
            let may_move = could_move && !hard.is_at_an_end;
            assert!(is_moved || !may_move, "{} {}: nothing moves", member.spec.id, hard.name);
            assert!(!is_moved || !hard.is_at_an_end, "{} {}: moved beyond an end", member.spec.id, hard.name);
        }
    }
    assert!(below > 1000 && above > 1000, "{below} below, {above} above");
}

#[test]
#[ignore = "long: ./x campaign long"]
fn stable_forms_keep_their_claims_and_naive_forms_fail_on_every_adapter() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let mut subjects = subjects();
    let built_in = code_of(None).expect("the built-in shaders are valid");
    let report = run(&mut subjects, &options(built_in), &mut Silent).expect("it runs");
    let broken: Vec<_> = report.stability.iter().filter(|one| !one.is_stable() || !one.naive_fails()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    let both_sided = |member: &Member| member.spec.hard.iter().filter(|hard| hard.naive.is_some()).count();
    let cases: usize = stable(&catalogue()).map(both_sided).sum();
    assert_eq!(report.stability.len(), cases * 2 * subjects.len(), "each case in two stages of every adapter");
    assert!(report.groups.iter().all(|group| group.totals.failed == 0 && group.problems.is_empty()));
}

/// The built-in shaders with every stable form's function calling that of its naive form.
fn naive_in_place() -> (Code, BTreeMap<String, &'static str>) {
    let catalogue = catalogue();
    let dir = folder("naive-in-place");
    let mut files: BTreeMap<String, String> =
        FILES.iter().map(|(name, text)| ((*name).into(), (*text).into())).collect();
    let mut replaced = BTreeMap::new();
    for member in stable(&catalogue) {
        let naive = member.spec.hard.iter().find_map(|hard| hard.naive).expect("a naive form");
        let rival = catalogue.iter().find(|other| other.spec.id == naive.formula).expect("a formula");
        let file = files.get_mut(&format!("{}.wgsl", member.spec.family())).expect("the family's file");
        let name = member.spec.function;
        let start = file.find(&format!("fn {name}(")).unwrap_or_else(|| panic!("no function {name}"));
        let head = &file[start..start + file[start..].find('{').expect("a body")];
        let arguments = &head[head.find('(').expect("arguments") + 1..head.rfind(')').expect("their end")];
        let names: Vec<&str> =
            arguments.split(',').filter_map(|a| a.split_once(':')).map(|(name, _)| name.trim()).collect();
        let call = format!("{head}{{\n    return {}({});\n}}\n", rival.spec.function, names.join(", "));
        let kept = file.replacen(&format!("fn {name}("), &format!("fn {name}_in_its_stable_form("), 1);
        *file = format!("{kept}\n{call}");
        replaced.insert(member.spec.group().to_owned(), naive.formula);
    }
    for (name, text) in files {
        std::fs::write(dir.join(name), text).expect("a shader can be written");
    }
    (code_of(Some(&dir)).unwrap_or_else(|error| panic!("{error}")), replaced)
}

#[test]
#[ignore = "long: ./x campaign long"]
fn each_stable_form_with_the_naive_one_in_its_place_is_found_out() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let (shaders, replaced) = naive_in_place();
    let mut subjects = subjects();
    let report = run(&mut subjects, &options(shaders), &mut Silent).expect("it runs");
    assert!(!report.is_success());
    for (group, naive) in &replaced {
        let of_group = || report.groups.iter().filter(|found| found.id == *group && found.stage != "fixed-function");
        assert_eq!(of_group().count(), 2 * subjects.len(), "{group} in two stages of every adapter");
        for found in of_group() {
            let problem = found.problem().unwrap_or_default();
            assert!(
                problem.contains("unstable at"),
                "{group} as {naive} on {}, {}: {problem}",
                found.adapter,
                found.stage
            );
        }
    }
}

/// The exact outputs of some formulas at rows of inputs, where there are any.
struct InExact<'a> {
    rows: &'a BTreeMap<&'static str, Vec<Vec<f32>>>,
    found: BTreeMap<String, Vec<Option<Vec<f64>>>>,
}

impl Visitor for InExact<'_> {
    fn formula<F: Formula>(&mut self, formula: F) {
        let spec = formula.spec();
        let Some(rows) = self.rows.get(spec.id.as_str()) else { return };
        let outputs = rows.iter().map(|row| {
            exact::clear();
            let inputs: Vec<Exact> = row.iter().map(|&x| Exact::input(x)).collect();
            let mut out = vec![Exact::literal(0.0); spec.output_len()];
            formula.evaluate(&Reader::new(&inputs), &mut Writer::new(&mut out, Wanted::ALL));
            out.iter().map(|y| y.get().map(|(value, _)| value.to_f64().value())).collect()
        });
        self.found.insert(spec.id.clone(), outputs.collect());
    }
}

/// The published form in 115 digits is what a stable form's f64 reference computes.
#[test]
fn a_stable_form_computes_what_its_naive_form_means() {
    let catalogue = catalogue();
    let mut rows = BTreeMap::<&'static str, Vec<Vec<f32>>>::new();
    let mut wanted = vec![];
    for member in stable(&catalogue).filter(|member| !OTHERS.contains(&member.spec.id.as_str())) {
        for (place, hard) in member.spec.hard.iter().enumerate() {
            let Some(naive) = hard.naive else { continue };
            for case in std::iter::once(CaseRef::Hard(place)).chain((0..member.near()).map(|k| CaseRef::Near(place, k)))
            {
                let mut row = vec![];
                member.inputs(case, 1, &mut row);
                let of = rows.entry(naive.formula).or_default();
                wanted.push((member, case, naive.formula, of.len()));
                of.push(row);
            }
        }
    }
    let mut exact = InExact { rows: &rows, found: BTreeMap::new() };
    visit(&mut exact);
    let mut compared = 0;
    for (member, case, naive, place) in wanted {
        // Some have no value, which is what is wrong with them.
        let Some(meant) = &exact.found[naive][place] else { continue };
        let mut own = vec![0.0; member.spec.output_len()];
        member.formula.reference(&rows[naive][place], &mut own);
        // Where a corner's 0 was moved to 2⁻¹²⁶, all that is left of products that cancel may be that.
        if meant.iter().all(|y| y.abs() < 1e-30) && meant.iter().any(|y| *y != 0.0) {
            continue;
        }
        let size = member.spec.stable.expect("a stable form").size;
        let error = roundings(&own, meant, size);
        // Bounded denominators differ from the unbounded where those cannot be divided by.
        let is_bounded = member.spec.id.starts_with("attenuation/") && meant.iter().any(|y| y.abs() >= 8e37);
        assert!(error < 1e-6 || is_bounded, "{} is off by {error} roundings from {naive}", member.case_id(case));
        compared += 1;
    }
    assert!(compared > 1500, "only {compared} cases have exact values");
}

fn conditioning(member: &Member, row: &[f32]) -> Conditioning {
    let mut legal = vec![Accept::ANY; member.spec.output_len()];
    member.formula.interval(row, &WGSL, &mut legal);
    stability::conditioning(member, row, &legal, &[])
}

/// Forms whose claims hold for the operations in the order in which they are written, which the language does not promise.
const AS_WRITTEN: [&str; 5] = [
    "interpolation/edge-compensated",
    "vector/face-normal-compensated",
    "fog/exp2-document",
    "fog/exp2-opengl",
    "blend/subtract-compensated",
];

#[test]
fn a_claim_covers_all_that_the_language_permits() {
    for member in stable(&catalogue()) {
        let spec = &member.spec;
        let bound = spec.stable.expect("a stable form").bound;
        let mut farthest = 0.0_f64;
        for place in (0..spec.hard.len()).filter(|&place| spec.hard[place].naive.is_some()) {
            for case in std::iter::once(CaseRef::Hard(place)).chain((0..member.near()).map(|k| CaseRef::Near(place, k)))
            {
                let mut row = vec![];
                member.inputs(case, 1, &mut row);
                farthest = farthest.max(conditioning(member, &row).reach.0);
            }
        }
        let is_covered = farthest <= bound;
        assert_eq!(
            is_covered,
            !AS_WRITTEN.contains(&spec.id.as_str()),
            "{} claims {bound}, legal are {farthest}",
            spec.id
        );
        // Nor is a claim so loose that it says nothing.
        assert!(
            !is_covered || bound <= 32.0 || bound <= 8.0 * farthest,
            "{} claims {bound}, legal are {farthest}",
            spec.id
        );
    }
}

/// The threshold has room above every published formula: what it calls unstable is no matter of a formula's length.
#[test]
fn published_formulas_are_not_called_unstable_on_random_cases() {
    let catalogue = catalogue();
    let naive: BTreeSet<&str> = stable(&catalogue)
        .flat_map(|member| member.spec.hard.iter().filter_map(|hard| Some(hard.naive?.formula)))
        .collect();
    let (mut unstable, mut all) = (BTreeMap::<&str, u64>::new(), 0);
    for member in catalogue.iter().filter(|member| member.spec.kind == Kind::Arithmetic) {
        if naive.contains(member.spec.id.as_str()) {
            continue;
        }
        for k in 0..256 {
            let mut row = vec![];
            member.inputs(CaseRef::Random(k), 1, &mut row);
            all += 1;
            if conditioning(member, &row).standing == FormStanding::Unstable {
                *unstable.entry(&member.spec.id).or_default() += 1;
            }
        }
    }
    let count: u64 = unstable.values().sum();
    assert!(count * 500 < all, "{count} of {all}: {unstable:?}");
}

#[test]
fn ill_conditioned_unstable_and_singular_are_told_apart() {
    let catalogue = catalogue();
    let standing = |id: &str| {
        let found = catalogue.iter().find_map(|member| member.case(id).map(|case| (member, case)));
        let (member, case) = found.unwrap_or_else(|| panic!("no case {id}"));
        let mut row = vec![];
        member.inputs(case, 1, &mut row);
        let CaseRef::Hard(place) = case else { panic!("{id} is no hard case") };
        let near = |k| {
            let mut row = vec![];
            member.inputs(CaseRef::Near(place, k), 1, &mut row);
            row
        };
        let near: Vec<Vec<f32>> = (0..member.near()).map(near).collect();
        let mut legal = vec![Accept::ANY; member.spec.output_len()];
        member.formula.interval(&row, &WGSL, &mut legal);
        stability::conditioning(member, &row, &legal, &near).standing
    };
    assert_eq!(standing("vector/halfway/hard/half-vector-of-nothing"), FormStanding::Singular);
    assert_eq!(standing("fog/linear/hard/dmin-equals-dmax-at-the-step"), FormStanding::Singular);
    assert_eq!(standing("vector/normalize-scaled/hard/length-1e30"), FormStanding::Stable);
    assert_eq!(standing("vector/normalize/hard/tiny"), FormStanding::NothingPromised);
    assert_eq!(standing("vector/interpolated-normal/hard/nearly-opposite"), FormStanding::IllConditioned);
    assert_eq!(standing("interpolation/weights/hard/no-area"), FormStanding::Singular);
    // The published power of a cosine that is near 1 loses what the chord keeps.
    let member = |id: &str| catalogue.iter().find(|member| member.spec.id == id).expect("a formula");
    let row = [0.0, 0.0, 1.0, 0.001_177_4, 0.0, 0.999_999_3, 1e6];
    assert_eq!(conditioning(member("lighting/cosine-power-by-chord"), &row).standing, FormStanding::Stable);
    assert_eq!(conditioning(member("fog/opacity"), &[1.0, 1e-7]).standing, FormStanding::Unstable);
    assert_eq!(conditioning(member("fog/opacity-expm1"), &[1.0, 1e-7]).standing, FormStanding::Stable);
}
