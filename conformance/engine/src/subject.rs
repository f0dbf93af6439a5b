//! What is judged: an adapter, or the embedded implementation, and how each of its stages evaluates a group of formulas.

use crate::device::{Code, Device, DeviceError, Own, Stages};
use crate::rows::Rows;
use lightmeter_catalogue::select::Member;
use lightmeter_document::run::Identity;
use lightmeter_judge::blend_unit::rules::Rules;
use lightmeter_judge::devices::Known;
use lightmeter_scene::blend::Route;
use lightmeter_scene::target::TargetFormat;

/// An implementation under test.
pub struct Subject {
    /// How it is named.
    pub identity: Identity,
    /// What is known of it.
    pub known: Known,
    device: Option<Box<dyn Device>>,
    /// What the embedded blend unit follows.
    rules: Rules,
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
}

/// Work that a device may still be doing.
pub enum Job {
    /// The device's own.
    Pending(Own),
    /// Done.
    Done(Vec<u32>),
}

impl Subject {
    /// A device, as it is named, and what is known of it.
    #[must_use]
    pub fn on_device(identity: Identity, known: Known, device: Box<dyn Device>) -> Self {
        Self { identity, known, device: Some(device), rules: Rules::RIGHT }
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
        Self { identity, known: Known::default(), device: None, rules: Rules::RIGHT }
    }

    /// The embedded implementation with a blend unit that follows other rules than the right ones.
    #[must_use]
    pub fn faulty(rules: Rules) -> Self {
        Self { rules, ..Self::embedded() }
    }

    /// The device; `None` of the embedded implementation.
    #[must_use]
    pub fn device(&self) -> Option<&dyn Device> {
        self.device.as_deref()
    }

    /// The device, to draw with; `None` of the embedded implementation.
    pub fn device_mut(&mut self) -> Option<&mut (dyn Device + 'static)> {
        self.device.as_deref_mut()
    }

    /// What the embedded blend unit follows.
    #[must_use]
    pub const fn rules(&self) -> &Rules {
        &self.rules
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
        let Some(device) = self.device_mut() else {
            return Ok(Compiled { stages: vec![(member.spec.row_stages()[0], Ok(Work::Embedded))] });
        };
        let stages = device.compile(code, member)?;
        Ok(Compiled { stages: stages.into_iter().map(|(stage, work)| (stage, work.map(Work::OnDevice))).collect() })
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
            Work::OnDevice(work) => {
                let device = self.device_mut().expect("only a device compiles work for a device");
                device.submit(work, rows).map(Job::Pending)
            }
        }
    }

    /// The outputs of rows, bit for bit, once they are there.
    ///
    /// # Errors
    /// Where the device failed or was lost.
    ///
    /// # Panics
    /// Where the job is not of this work.
    pub fn finish(&self, work: &Work, job: Job, rows: &Rows<'_>) -> Result<Vec<u32>, DeviceError> {
        match (work, job) {
            (_, Job::Done(words)) => Ok(words),
            (Work::OnDevice(work), Job::Pending(job)) => {
                self.device().expect("only a device has pending work").finish(work, job, rows)
            }
            (Work::Embedded, Job::Pending(_)) => unreachable!("a job is finished by the work that submitted it"),
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
