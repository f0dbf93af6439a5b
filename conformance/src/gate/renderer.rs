//! A renderer in this process.

use super::answer::{Hello, Line};
use super::ledger::Ledger;
use super::plan::{Place, Plan};
use crate::cases::Spec;
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
    plan: &Plan,
    renderer: &mut impl Renderer,
    folder: &Path,
) -> Result<(), super::process::Error> {
    let hello = renderer.hello();
    for batch in ledger.begin(&hello)?.chunks(super::pack::LINES) {
        let mut lines = vec![];
        for (number, &place) in (1..).zip(batch) {
            let id = plan.id(place);
            let line = match place {
                Place::Case { formula, case } => {
                    let spec = &plan.member(formula).spec;
                    match renderer.evaluate(spec, &plan.inputs(formula, case)) {
                        Ok(values) => Line::Value(Cow::Owned(id), values),
                        Err(reason) => Line::Skip(Cow::Owned(id), Cow::Owned(reason)),
                    }
                }
                Place::Scene(scene) => {
                    let (_, frame) = plan.frame(scene)?;
                    match renderer.draw(&id, &frame, folder) {
                        Ok(file) => Line::Image(Cow::Owned(id), Cow::Owned(file)),
                        Err(reason) => Line::Skip(Cow::Owned(id), Cow::Owned(reason)),
                    }
                }
            };
            lines.push((number, line));
        }
        ledger.read(lines, folder, false);
    }
    Ok(())
}
