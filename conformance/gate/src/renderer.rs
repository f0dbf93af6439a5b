//! A renderer in this process.

use super::answer::{Hello, Line};
use super::ledger::Ledger;
use super::plan::{CasePlace, GatePlan};
use lightmeter_catalogue::cases::Spec;
use lightmeter_scene::frame::Frame;
use std::borrow::Cow;
use std::path::Path;

/// A renderer in Rust. What it does not do it skips, by name, with a reason.
pub trait Renderer {
    /// Who it is, and what it is to be asked.
    fn hello(&self) -> Hello;

    /// The outputs of a formula for a row of inputs, in the order of its description.
    ///
    /// # Errors
    /// Why it does not evaluate this.
    fn evaluate(&mut self, spec: &Spec, inputs: &[f32]) -> Result<Vec<f32>, String>;

    /// Draws a frame to a file in the folder: its name, which ends in .png, .exr or .npy.
    ///
    /// # Errors
    /// Why it does not draw this.
    fn draw(&mut self, id: &str, frame: &Frame, folder: &Path) -> Result<String, String> {
        let _ = (frame, folder);
        Err(format!("no scenes, and so not {id}"))
    }
}

/// Asks a renderer every case of the ledger's plan that it declares. Images go to the folder.
///
/// # Errors
/// Where a glob of what it declares cannot be read, or a scene is refused.
pub fn ask(
    ledger: &mut Ledger<'_>,
    plan: &GatePlan,
    renderer: &mut impl Renderer,
    folder: &Path,
) -> Result<(), super::error::ProcessError> {
    let hello = renderer.hello();
    for batch in ledger.begin(&hello)?.chunks(super::answers::LINES) {
        let mut lines = vec![];
        for (number, &place) in (1..).zip(batch) {
            let id = plan.id(place);
            let line = match place {
                CasePlace::Case { formula, case } => {
                    let spec = &plan.member(formula).spec;
                    match renderer.evaluate(spec, &plan.inputs(formula, case)) {
                        Ok(values) => Line::Value(Cow::Owned(id), values),
                        Err(reason) => Line::Skip(Cow::Owned(id), Cow::Owned(reason)),
                    }
                }
                CasePlace::Scene(scene) => {
                    let (_, frame) = plan.frame(scene)?;
                    match renderer.draw(&id, &frame, folder) {
                        Ok(file) => Line::Image(Cow::Owned(id), Cow::Owned(file)),
                        Err(reason) => Line::Skip(Cow::Owned(id), Cow::Owned(reason)),
                    }
                }
            };
            lines.push((number, line));
        }
        ledger.read(lines, folder);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::process::Ending;
    use super::super::report::report;
    use super::*;
    use lightmeter_arithmetic::profile::WGSL;
    use lightmeter_catalogue::select::{Member, catalogue};
    use lightmeter_document::gate::GateReport;
    use lightmeter_document::pack::Choice;
    use lightmeter_faults::scene::{SCENE_FAULTS, draw};
    use lightmeter_faults::{Variation, concerning};

    /// The formulas in f32, one of them with a mistake; scenes with another.
    struct Wrong {
        catalogue: Vec<Member>,
        fault: Option<(&'static str, &'static str)>,
        scene_fault: Option<&'static str>,
    }

    impl Renderer for Wrong {
        fn hello(&self) -> Hello {
            Hello { renderer: "wrong".into(), ..Hello::everything() }
        }

        fn evaluate(&mut self, spec: &Spec, inputs: &[f32]) -> Result<Vec<f32>, String> {
            let member = self.catalogue.iter().find(|member| member.spec.id == spec.id).ok_or("no such formula")?;
            let mut out = vec![0.0_f32; spec.output_len()];
            match self.fault.filter(|(_, formula)| *formula == spec.id) {
                None => member.formula.embedded(inputs, &mut out),
                Some((name, _)) => {
                    let fault =
                        concerning(spec).into_iter().find(|fault| fault.name == name).ok_or("no such mistake")?;
                    let variation = Variation::new(member, &[fault]).ok_or("it does not concern the formula")?;
                    variation.evaluate(inputs, &mut out);
                }
            }
            Ok(out)
        }

        fn draw(&mut self, id: &str, frame: &Frame, folder: &Path) -> Result<String, String> {
            let fault = self.scene_fault.and_then(|name| SCENE_FAULTS.iter().find(|fault| fault.name == name));
            let image = draw::<f32>(frame, &fault.into_iter().collect::<Vec<_>>());
            let name = format!("{}.exr", id.replace('/', "-"));
            image.write(&folder.join(&name)).map_err(|error| error.to_string())?;
            Ok(name)
        }
    }

    fn gate(
        filter: &[&str],
        fault: Option<(&'static str, &'static str)>,
        scene_fault: Option<&'static str>,
    ) -> GateReport {
        // Each call has a folder of its own: tests run at the same time in one process.
        let name = filter.join("+").replace('/', "-");
        let folder = std::env::temp_dir().join(format!("lightmeter-renderer-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder can be made");
        let filter = filter.iter().map(|&glob| glob.to_owned()).collect();
        let plan = GatePlan::new(Choice { filter, cases: 64, seed: 1, size: Some(48) }).expect("the globs are valid");
        let mut ledger = Ledger::new(&plan, &WGSL);
        let mut renderer = Wrong { catalogue: catalogue(), fault, scene_fault };
        ask(&mut ledger, &plan, &mut renderer, &folder).unwrap_or_else(|error| panic!("{error}"));
        let _ = std::fs::remove_dir_all(&folder);
        report(&mut ledger, Ending::default(), String::new(), 0.0)
    }

    #[test]
    fn what_is_right_passes() {
        let report = gate(&["fog", "vector", "scene/flat"], None, None);
        let failed: Vec<_> = report.groups.iter().filter(|group| group.is_failed()).collect();
        assert!(failed.is_empty() && report.has_judged(), "{failed:?}");
    }

    #[test]
    fn a_mistake_in_a_formula_and_one_in_a_scene_are_told_by_name() {
        let report = gate(&["fog/linear", "fog/exp"], Some(("fog-smoothstep", "fog/linear")), None);
        let said: Vec<_> = report.groups.iter().filter_map(|group| group.diagnosis.clone()).collect();
        assert!(said.len() == 1 && said[0].contains("smoothstep"), "{said:?}");
        let report = gate(&["scene/fog-exp2-opengl", "scene/flat", "scene/gouraud"], None, Some("fog-distance"));
        let said: Vec<_> = report.groups.iter().filter_map(|group| group.diagnosis.clone()).collect();
        assert!(said.len() == 1 && said[0].contains("radial for planar"), "{said:?}");
    }
}
