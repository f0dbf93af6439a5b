//! How a mistake looks: which answers it makes wrong, and on which side.

use super::fault::Fault;
use super::variation::Variation;
use lightmeter_arithmetic::Accept;
use lightmeter_arithmetic::profile::WGSL;
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::Word;
use lightmeter_document::mistakes::MistakeLook;

/// Random cases that are tried, besides the hard ones.
const CASES: u64 = 256;

/// How a mistake looks in a formula; `None` where it does not concern it.
#[must_use]
pub fn look(member: &Member, fault: &'static Fault) -> Option<MistakeLook> {
    let (variation, spec) = (Variation::new(member, &[fault])?, &member.spec);
    let usual: Vec<CaseRef> = member.hard_and_near().chain((0..CASES).map(CaseRef::Random)).collect();
    let outputs = spec.output_len();
    let (mut out, mut reference, mut legal) = (vec![0.0_f32; outputs], vec![0.0; outputs], vec![Accept::ANY; outputs]);
    let mut wrong = vec![false; outputs];
    let formula = spec.id.clone();
    let mut look = MistakeLook { formula, cases: 0, failing: 0, too_great: 0, too_small: 0, outputs: vec![] };
    let count = usual.len();
    // A mistake that none of them shows is shown by cases close to where the formula decides or degenerates.
    for (place, case) in usual.into_iter().chain((0..member.boundary()).map(CaseRef::Boundary)).enumerate() {
        if place == count && look.failing > 0 {
            break;
        }
        look.cases += 1;
        let mut row = vec![];
        member.inputs(case, 1, &mut row);
        variation.evaluate(&row, &mut out);
        member.formula.reference(&row, &mut reference);
        member.formula.promised_interval(spec.kind, &row, &WGSL, &mut legal);
        let mut fails = false;
        for (k, value) in out.iter().map(|&x| f64::from(x)).enumerate() {
            if legal[k].contains(value) {
                continue;
            }
            (fails, wrong[k]) = (true, true);
            look.too_great += usize::from(value > reference[k]);
            look.too_small += usize::from(value < reference[k]);
        }
        look.failing += usize::from(fails);
    }
    let mut start = 0;
    for output in spec.outputs {
        let end = start + output.shape.components();
        if wrong[start..end].contains(&true) {
            look.outputs.push(Word::from(output.name));
        }
        start = end;
    }
    Some(look)
}
