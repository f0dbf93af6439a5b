//! What is judged: an adapter, the embedded implementation or another renderer, and how each of its stages evaluates a group of formulas.

use crate::device::{Code, Device, DeviceError, Own, Stages};
use crate::renderer::AskedRenderer;
use crate::rows::Rows;
use lightmeter_catalogue::cases::Stage;
use lightmeter_catalogue::select::Member;
use lightmeter_document::report::Identity;
use lightmeter_judge::blend_unit::rules::Rules;
use lightmeter_judge::cases::Answers;
use lightmeter_judge::devices::Known;
use lightmeter_scene::blend::Route;
use lightmeter_scene::target::TargetFormat;

/// An implementation under test.
pub struct Subject {
    /// How it is named.
    pub identity: Identity,
    /// What is known of it.
    pub known: Known,
    answers: Answering,
}

/// Who answers.
enum Answering {
    /// The formulas in f32, and a blend unit that follows these rules.
    Embedded(Rules),
    Device(Box<dyn Device>),
    Renderer(Box<dyn AskedRenderer>),
}

/// The stages of a subject, compiled for one group of formulas.
pub struct Compiled {
    /// Each stage, or why it is skipped.
    pub stages: Stages<Work>,
}

/// How a stage evaluates.
pub enum Work {
    /// On the subject's device.
    OnDevice(Own),
    /// The formulas in f32, on this processor.
    Embedded,
    /// A renderer, asked case by case.
    Asked,
}

/// Work that a device may still be doing.
pub enum Job {
    /// The device's own.
    Pending(Own),
    /// Done.
    Done(Vec<u32>),
    /// To be asked once it is waited for.
    Asked,
}

impl Subject {
    /// A device, as it is named, and what is known of it.
    #[must_use]
    pub fn on_device(identity: Identity, known: Known, device: Box<dyn Device>) -> Self {
        Self { identity, known, answers: Answering::Device(device) }
    }

    /// Another renderer. The suite knows no deviations of it.
    #[must_use]
    pub fn renderer(identity: Identity, renderer: Box<dyn AskedRenderer>) -> Self {
        Self { identity, known: Known::default(), answers: Answering::Renderer(renderer) }
    }

    /// The formulas themselves in f32, which need no driver. They prove nothing about the reference, which they share.
    #[must_use]
    pub fn embedded() -> Self {
        let identity = Identity {
            name: "cpu".into(),
            device: "the reference's formulas in f32".into(),
            backend: "embedded".into(),
            driver: concat!("lightmeter ", env!("CARGO_PKG_VERSION")).into(),
        };
        Self { identity, known: Known::default(), answers: Answering::Embedded(Rules::RIGHT) }
    }

    /// The embedded implementation with a blend unit that follows other rules than the right ones.
    #[must_use]
    pub fn faulty(rules: Rules) -> Self {
        Self { answers: Answering::Embedded(rules), ..Self::embedded() }
    }

    /// The device; `None` of any other subject.
    #[must_use]
    pub fn device(&self) -> Option<&dyn Device> {
        if let Answering::Device(device) = &self.answers { Some(&**device) } else { None }
    }

    /// The device, to draw with; `None` of any other subject.
    pub fn device_mut(&mut self) -> Option<&mut (dyn Device + 'static)> {
        if let Answering::Device(device) = &mut self.answers { Some(&mut **device) } else { None }
    }

    /// The renderer that is asked case by case; `None` of any other subject.
    #[must_use]
    pub fn asked(&self) -> Option<&dyn AskedRenderer> {
        if let Answering::Renderer(renderer) = &self.answers { Some(&**renderer) } else { None }
    }

    /// The renderer, to be asked; `None` of any other subject.
    pub fn asked_mut(&mut self) -> Option<&mut (dyn AskedRenderer + 'static)> {
        if let Answering::Renderer(renderer) = &mut self.answers { Some(&mut **renderer) } else { None }
    }

    /// What the embedded blend unit follows.
    #[must_use]
    pub const fn rules(&self) -> &Rules {
        if let Answering::Embedded(rules) = &self.answers { rules } else { &Rules::RIGHT }
    }

    /// Why a target cannot be blended on; `None` where it can.
    #[must_use]
    pub fn lacks_blending(&self, target: TargetFormat) -> Option<&'static str> {
        self.device()?.lacks_blending(target)
    }

    /// Why a route is not open; `None` where it is. The embedded unit has every factor of its own.
    ///
    /// # Errors
    /// Where a shader is invalid, or the driver gives no device.
    pub fn lacks_route(&mut self, code: &Code, route: Route) -> Result<Option<&'static str>, DeviceError> {
        let missing = "the embedded implementation has every factor of its own";
        match self.device_mut() {
            Some(device) => device.lacks_route(code, route),
            None => Ok((route == Route::DualSource).then_some(missing)),
        }
    }

    /// Compiles what the formulas of a group need, each of which the first stands for.
    ///
    /// # Errors
    /// Where a shader is invalid or the device refuses it.
    pub fn compile(&mut self, code: &Code, member: &Member) -> Result<Compiled, DeviceError> {
        let stages = match &mut self.answers {
            Answering::Embedded(_) => vec![(member.spec.row_stages()[0], Ok(Work::Embedded))],
            Answering::Renderer(_) => vec![(Stage::Answer, Ok(Work::Asked))],
            Answering::Device(device) => {
                let stages = device.compile(code, member)?.into_iter();
                stages.map(|(stage, work)| (stage, work.map(Work::OnDevice))).collect()
            }
        };
        Ok(Compiled { stages })
    }

    /// Starts the evaluation of rows by a stage.
    ///
    /// # Errors
    /// Where the device refuses it.
    ///
    /// # Panics
    /// Where the work was not compiled by this subject.
    pub fn submit(&mut self, work: &Work, rows: &Rows<'_>) -> Result<Job, DeviceError> {
        match work {
            Work::Embedded => Ok(Job::Done(embedded(rows))),
            Work::Asked => Ok(Job::Asked),
            Work::OnDevice(work) => {
                let device = self.device_mut().expect("only a device compiles work for a device");
                device.submit(work, rows).map(Job::Pending)
            }
        }
    }

    /// What there is to rows once it is there. `advanced` hears how many cases of a renderer are done.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    ///
    /// # Panics
    /// Where the job is not of this work.
    pub fn finish(
        &mut self,
        work: &Work,
        job: Job,
        rows: &Rows<'_>,
        advanced: &mut dyn FnMut(u64),
    ) -> Result<Answers, DeviceError> {
        match (&mut self.answers, work, job) {
            (_, _, Job::Done(words)) => Ok(words.into()),
            (Answering::Device(device), Work::OnDevice(work), Job::Pending(job)) => {
                device.finish(work, job, rows).map(Answers::from)
            }
            (Answering::Renderer(renderer), Work::Asked, Job::Asked) => renderer.values(rows, advanced),
            _ => unreachable!("a job is finished by the subject and the work that submitted it"),
        }
    }
}

fn embedded(rows: &Rows<'_>) -> Vec<u32> {
    use rayon::prelude::*;
    let mut words = vec![0; rows.of.len() * rows.outputs];
    words.par_chunks_mut(rows.outputs).zip(rows.inputs.par_chunks(rows.stride())).zip(rows.of).for_each(
        |((words, inputs), &member)| {
            let mut out = vec![0.0; words.len()];
            rows.members[member].formula.embedded(inputs, &mut out);
            for (word, value) in words.iter_mut().zip(out) {
                *word = value.to_bits();
            }
        },
    );
    words
}
