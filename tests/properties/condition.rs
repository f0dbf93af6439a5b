//! The condition number against a difference quotient: it says how far an output moves when its inputs do.

use lightmeter::select::{CaseRef, catalogue};

#[test]
fn it_bounds_how_far_an_output_moves() {
    let mut checked = 0;
    for member in
        catalogue().iter().filter(|member| member.spec.family() == "fog" || member.spec.family() == "attenuation")
    {
        for k in 0..64 {
            let mut row = vec![];
            member.inputs(CaseRef::Random(k), 3, &mut row);
            let outputs = member.spec.output_len();
            let (mut here, mut there) = (vec![0.0; outputs], vec![0.0; outputs]);
            member.formula.reference(&row, &mut here);
            // All inputs moved by the same small share.
            let share = 1.0 / 65536.0;
            let moved: Vec<f32> = row.iter().map(|x| x * (1.0 + share)).collect();
            member.formula.reference(&moved, &mut there);
            for (output, condition) in member.formula.condition(&row).into_iter().enumerate() {
                let change = ((there[output] - here[output]) / here[output]).abs();
                if !change.is_finite() || here[output].abs() < 1e-6 || here[output] == 1.0 || there[output] == 1.0 {
                    continue;
                }
                checked += 1;
                let most = 1.02 * condition * f64::from(share) + 1e-6;
                assert!(change <= most, "{} {k}: moved by {change:e}, condition {condition}", member.spec.id);
            }
        }
    }
    assert!(checked > 1000, "only {checked} outputs were checked");
}

#[test]
fn cancellation_has_a_great_one() {
    let catalogue = catalogue();
    let member = catalogue.iter().find(|member| member.spec.id == "vector/halfway").expect("halfway is a formula");
    let condition = |l: [f32; 3]| member.formula.condition(&[0.0, 0.0, 1.0, l[0], l[1], l[2]])[0];
    assert!(condition([1e-4, 0.0, -0.9999]) > 1e3);
    assert!(condition([0.6, 0.0, 0.8]) < 10.0);
}
