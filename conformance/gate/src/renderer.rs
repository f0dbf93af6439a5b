//! A renderer in this process.

use super::answer::Line;
use super::error::ProcessError;
use super::expectations::Expectations;
use super::given::{Asks, Declared, Given, given, put};
use super::hello::Hello;
use super::picture;
use super::words::clipped;
use lightmeter_catalogue::cases::Spec;
use lightmeter_catalogue::cases::blend::{Program, UnitCase};
use lightmeter_catalogue::select::CaseRef;
use lightmeter_catalogue::special::Probe;
use lightmeter_document::by_case::{RendererUse, SourcePlace};
use lightmeter_document::report::Identity;
use lightmeter_engine::device::DeviceError;
use lightmeter_engine::renderer::{AskedPixels, AskedRenderer, AskedScene};
use lightmeter_engine::rows::Rows;
use lightmeter_judge::blend_unit::pixel::Units;
use lightmeter_judge::cases::{Answers, Unanswered};
use lightmeter_judge::image::file::StoredImage;
use lightmeter_scene::frame::Frame;
use lightmeter_scene::target::TargetFormat;
use std::any::Any;
use std::borrow::Cow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// A renderer in Rust. What it does not do it skips, by name, with a reason.
pub trait Renderer {
    /// Who it is, and what it is to be asked.
    fn hello(&self) -> Hello;

    /// The outputs of a formula for a row of inputs, in the order of its description. Where it panics, the case fails and the rest goes on.
    ///
    /// # Errors
    /// Why it does not evaluate this.
    fn evaluate(&mut self, spec: &Spec, inputs: &[f32]) -> Result<Vec<f32>, String>;

    /// What a blend state leaves on a target that its hello declares: red, green, blue and alpha, in steps of 8 bits as they are stored or
    /// in numbers of a float format.
    ///
    /// # Errors
    /// Why it does not blend so.
    fn blend(&mut self, program: Program, target: TargetFormat, case: &UnitCase) -> Result<[f32; 4], String> {
        let _ = (program, case);
        Err(format!("no blending on {}", target.name()))
    }

    /// The bits that an operation on special values comes to, where its hello declares that it is asked for them.
    ///
    /// # Errors
    /// Why it does not do this.
    fn special(&mut self, probe: &Probe) -> Result<u32, String> {
        Err(format!("no {}", probe.what))
    }

    /// Draws a frame to a file in the folder: its name, which ends in .png, .exr or .npy.
    ///
    /// # Errors
    /// Why it does not draw this.
    fn draw(&mut self, id: &str, frame: &Frame, folder: &Path) -> Result<String, String> {
        let _ = (frame, folder);
        Err(format!("no scenes, and so not {id}"))
    }
}

/// Cases of a formula at which a function may panic before no more of them are evaluated: each panic prints a message of its own.
const MOST_PANICS: usize = 3;

/// What a panic says.
fn said(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("it says nothing")
}

/// A renderer in this process, as a subject of the engine. Images go to a folder.
pub struct InProcess<R> {
    renderer: Mutex<R>,
    declared: Declared,
    folder: PathBuf,
}

impl<R: Renderer + Send> InProcess<R> {
    /// Hears what it declares.
    ///
    /// # Errors
    /// Where a glob of that cannot be read.
    pub fn new(renderer: R, folder: PathBuf) -> Result<Self, ProcessError> {
        let declared = Declared::new(renderer.hello())?;
        Ok(Self { renderer: Mutex::new(renderer), declared, folder })
    }

    /// Some of its cases are known to be skipped.
    pub fn expect(&mut self, expectations: &Expectations) {
        let Hello { renderer, version, .. } = &self.declared.hello;
        let known = expectations.skips_of(renderer, version);
        self.declared.skips.extend(known);
    }

    /// How it is named in reports.
    #[must_use]
    pub fn identity(&self) -> Identity {
        self.declared.identity()
    }

    fn renderer(&mut self) -> &mut R {
        self.renderer.get_mut().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

impl<R: Renderer + Send> AskedRenderer for InProcess<R> {
    fn lacks(&self, id: &str) -> Option<String> {
        self.declared.lacks(id)
    }

    fn lacks_frame(&self, frame: &Frame) -> Option<String> {
        self.declared.lacks_frame(frame)
    }

    fn source(&self, id: &str) -> Option<SourcePlace> {
        self.declared.source(id)
    }

    fn values(&mut self, rows: &Rows<'_>, advanced: &mut dyn FnMut(u64)) -> Result<Answers, DeviceError> {
        let skips = self.declared.skips.clone();
        let renderer = self.renderer();
        let each = rows.of.iter().zip(rows.cases).zip(rows.inputs.chunks_exact(rows.stride()));
        let mut panics = 0;
        let given = each.map(|((&of, &case), inputs)| {
            let (spec, id) = (&rows.members[of].spec, rows.members[of].case_id(case));
            if panics >= MOST_PANICS {
                return Given::Nothing(Unanswered::Unasked);
            }
            let line = match catch_unwind(AssertUnwindSafe(|| renderer.evaluate(spec, inputs))) {
                Ok(Ok(values)) => Line::Value(Cow::Borrowed(""), values.into_iter().map(f64::from).collect()),
                Ok(Err(reason)) => Line::Skip(Cow::Borrowed(""), Cow::Owned(reason)),
                Err(panic) => {
                    panics += 1;
                    Line::Error(Cow::Borrowed(""), Cow::Owned(format!("the function panicked: {}", said(&*panic))))
                }
            };
            skips.settled(&id, given(line, Asks::Outputs(spec)))
        });
        let mut answers = Answers { words: vec![0; rows.of.len() * rows.outputs], ..Answers::default() };
        given.enumerate().for_each(|(place, given)| put(&mut answers, rows.outputs, place, given));
        advanced(rows.of.len() as u64);
        Ok(answers)
    }

    fn targets(&self) -> Vec<TargetFormat> {
        self.declared.targets.clone()
    }

    fn pixels(&mut self, asked: &AskedPixels<'_>) -> Result<Vec<Result<Units, Unanswered>>, DeviceError> {
        let skips = self.declared.skips.clone();
        let blended = |(case, inputs): (CaseRef, &[f32])| {
            let pixel = self.renderer().blend(asked.program, asked.target, &asked.program.case(inputs));
            pixel.map(|pixel| pixel.map(f64::from)).map_err(|reason| skips.skipped(&asked.id(case), clipped(&reason)))
        };
        Ok(asked.rows().map(blended).collect())
    }

    fn asks_special(&self) -> bool {
        self.declared.hello.special
    }

    fn probes(&mut self, probes: &[&'static Probe]) -> Result<Vec<Result<u32, Unanswered>>, DeviceError> {
        let skips = self.declared.skips.clone();
        let renderer = self.renderer();
        let answer = |probe: &&'static Probe| {
            renderer.special(probe).map_err(|reason| skips.skipped(&probe.id(), clipped(&reason)))
        };
        Ok(probes.iter().map(answer).collect())
    }

    fn image(&mut self, scene: AskedScene<'_>) -> Result<Result<StoredImage, Unanswered>, DeviceError> {
        let folder = self.folder.clone();
        Ok(match self.renderer().draw(scene.id, scene.frame, &folder) {
            Ok(file) => picture::read(&folder, &file, scene.frame, None).map_err(Unanswered::Unjudged),
            Err(reason) => Err(self.declared.skips.skipped(scene.id, clipped(&reason))),
        })
    }

    fn begin_again(&mut self) -> Result<(), DeviceError> {
        Ok(())
    }

    fn asks_failing_again(&self) -> bool {
        false
    }

    fn is_over(&self) -> bool {
        false
    }

    fn used(&mut self) -> RendererUse {
        self.declared.used()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::filter::Filter;
    use lightmeter_catalogue::select::{Member, catalogue};
    use lightmeter_document::event::Silent;
    use lightmeter_document::report::Report;
    use lightmeter_engine::device::Code;
    use lightmeter_engine::options::Options;
    use lightmeter_engine::run::run;
    use lightmeter_engine::subject::Subject;
    use lightmeter_faults::scene::{SCENE_FAULTS, draw};
    use lightmeter_faults::{Mistakes, Variation, concerning};

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
                        concerning(member).into_iter().find(|fault| fault.name == name).ok_or("no such mistake")?;
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

    fn gate(filter: &[&str], fault: Option<(&'static str, &'static str)>, scene_fault: Option<&'static str>) -> Report {
        // Each call has a folder of its own: tests run at the same time in one process.
        let name = filter.join("+").replace('/', "-");
        let folder = std::env::temp_dir().join(format!("lightmeter-renderer-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder can be made");
        let renderer = Wrong { catalogue: catalogue(), fault, scene_fault };
        let renderer = InProcess::new(renderer, folder.clone()).expect("what it declares can be read");
        let options = Options {
            filter: Filter::new(filter).expect("the globs are valid"),
            cases: 64,
            size: Some(48),
            diagnose: Some(&Mistakes),
            ..Options::new(Code::default())
        };
        let mut subject = Subject::renderer(renderer.identity(), Box::new(renderer));
        let report = run(std::slice::from_mut(&mut subject), &options, &mut Silent);
        let _ = std::fs::remove_dir_all(&folder);
        report.expect("nothing fails but the renderer")
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
        let said: Vec<_> =
            report.groups.iter().filter_map(|group| group.diagnosis.as_ref().map(ToString::to_string)).collect();
        assert!(said.len() == 1 && said[0].contains("smoothstep"), "{said:?}");
        let report = gate(&["scene/fog-exp2-opengl", "scene/flat", "scene/gouraud"], None, Some("fog-radial"));
        let said: Vec<_> =
            report.groups.iter().filter_map(|group| group.diagnosis.as_ref().map(ToString::to_string)).collect();
        assert!(said.len() == 1 && said[0].contains("fog is by the distance from the eye"), "{said:?}");
    }
}
