//! How large the errors of a formula are where it is computed in binary32 as it is written.

use lightmeter_arithmetic::format::error_ulp;
use lightmeter_arithmetic::profile::WGSL;
use lightmeter_arithmetic::{Accept, F32};
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::select::{CaseRef, Member};

/// Random cases, beside the hard ones and those near them.
pub(crate) const CASES: u64 = 2048;

/// The errors of one number of the outputs.
pub(crate) struct OutputErrors {
    /// Its name.
    pub(crate) name: String,
    /// The greatest error of binary32 at random cases, in ULP.
    pub(crate) random: f64,
    /// The same at hard cases and near them.
    pub(crate) hard: Option<f64>,
    /// How far legal values reach from the reference at most, in ULP, at random cases where they are bounded.
    pub(crate) legal: f64,
    /// The share of random cases at which any value is legal.
    pub(crate) anything: f64,
    /// The median of the condition numbers at random cases.
    pub(crate) condition: f64,
}

/// Cases whose condition numbers are worked out.
const CONDITIONED: u64 = 128;

/// The errors of each number of the outputs; none of a formula of the rasteriser, which has no binary32 form of its own.
pub(crate) fn errors(member: &Member) -> Vec<OutputErrors> {
    if matches!(member.spec.kind, Kind::Raster(_)) {
        return vec![];
    }
    let outputs = member.spec.output_len();
    let mut found: Vec<OutputErrors> = (0..outputs)
        .map(|k| OutputErrors {
            name: member.spec.output_name(k),
            random: 0.0,
            hard: (!member.spec.hard.is_empty()).then_some(0.0),
            legal: 0.0,
            anything: 0.0,
            condition: 0.0,
        })
        .collect();
    let (mut value, mut reference, mut legal) =
        (vec![0.0_f32; outputs], vec![0.0; outputs], vec![Accept::ANY; outputs]);
    let mut conditions = vec![vec![]; outputs];
    for case in member.hard_and_near().chain((0..CASES).map(CaseRef::Random)) {
        let mut row = vec![];
        member.inputs(case, 1, &mut row);
        member.formula.embedded(&row, &mut value);
        member.formula.reference(&row, &mut reference);
        member.formula.interval(&row, &WGSL, &mut legal);
        if matches!(case, CaseRef::Random(k) if k < CONDITIONED) {
            conditions.iter_mut().zip(member.formula.condition(&row)).for_each(|(all, one)| all.push(one));
        }
        for (k, errors) in found.iter_mut().enumerate() {
            let error = |x: f32| error_ulp::<F32>(x, reference[k]);
            let own = error(value[k]);
            if matches!(case, CaseRef::Random(_)) {
                errors.random = errors.random.max(own);
                #[expect(clippy::cast_possible_truncation, reason = "ends of intervals are judged as values")]
                let reach = [legal[k].low(), legal[k].high()].map(|x| x as f32);
                if reach.iter().all(|x| x.is_finite()) {
                    errors.legal = errors.legal.max(error(reach[0])).max(error(reach[1]));
                } else {
                    #[expect(clippy::cast_precision_loss, reason = "a count of cases")]
                    let all = CASES as f64;
                    errors.anything += 1.0 / all;
                }
            } else if let Some(hard) = &mut errors.hard {
                *hard = hard.max(own);
            }
        }
    }
    for (errors, mut conditions) in found.iter_mut().zip(conditions) {
        conditions.sort_by(f64::total_cmp);
        errors.condition = conditions.get(conditions.len() / 2).copied().unwrap_or(f64::NAN);
    }
    found
}
