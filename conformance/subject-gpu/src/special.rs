//! The probes of special values on a device.

use lightmeter_catalogue::special::{Probe, Way};
use lightmeter_engine::device::Probed;
use lightmeter_gpu::{ArithmeticPipeline, Gpu, GpuError, Kernel, Pending, Programmable, RasterPipeline, Shaders};
use lightmeter_scene::raster::{Provoking, Raster, Topology};

/// The shader file of the functions.
const FILE: &str = "special.wgsl";

/// Evaluates some probes in every stage.
pub(super) fn special(gpu: &Gpu, shaders: &Shaders, probes: &[&'static Probe]) -> Result<Probed, GpuError> {
    let kernels = functions(probes)
        .into_iter()
        .map(|function| Ok((function, Kernel::new(shaders, FILE, function)?)))
        .collect::<Result<Vec<_>, GpuError>>()?;
    let mut probed = Probed::default();
    // All are handed over before the first is waited for, since a device elsewhere takes its time over each answer.
    let mut shaded = vec![];
    for (stage, name) in [(Programmable::Compute, "compute"), (Programmable::Fragment, "fragment")] {
        for (function, kernel) in &kernels {
            match Shaded::begin(gpu, kernel, of_function(probes, function), (stage, name))? {
                Ok(begun) => shaded.push(begun),
                Err(reason) => skip(&mut probed, name, reason),
            }
        }
    }
    for begun in shaded {
        begun.end(gpu, &mut probed)?;
    }
    for flat in [false, true] {
        let carried: Vec<&'static Probe> =
            probes.iter().copied().filter(|probe| probe.way == Way::Varying { flat }).collect();
        if !carried.is_empty() {
            carry(gpu, shaders, flat, &carried, &mut probed)?;
        }
    }
    Ok(probed)
}

fn skip(probed: &mut Probed, stage: &'static str, reason: &'static str) {
    if !probed.skipped.contains(&(stage, reason)) {
        probed.skipped.push((stage, reason));
    }
}

/// The functions that some probes call, each once.
fn functions(probes: &[&Probe]) -> Vec<&'static str> {
    let mut functions = vec![];
    for probe in probes {
        if let Way::Function(function) = probe.way
            && !functions.contains(&function)
        {
            functions.push(function);
        }
    }
    functions
}

fn of_function(probes: &[&'static Probe], function: &str) -> Vec<&'static Probe> {
    probes.iter().copied().filter(|probe| matches!(probe.way, Way::Function(name) if name == function)).collect()
}

/// The probes of one function in one stage, which the device evaluates.
struct Shaded {
    probes: Vec<&'static Probe>,
    stage: &'static str,
    pipeline: ArithmeticPipeline,
    pending: Pending,
}

impl Shaded {
    /// Hands the probes over; `Ok(Err(reason))` where the device lacks the stage.
    fn begin(
        gpu: &Gpu,
        kernel: &Kernel,
        probes: Vec<&'static Probe>,
        (programmable, stage): (Programmable, &'static str),
    ) -> Result<Result<Self, &'static str>, GpuError> {
        let rows: Vec<f32> = probes.iter().flat_map(|probe| probe.inputs).map(|bits| f32::from_bits(*bits)).collect();
        let made = ArithmeticPipeline::new(gpu, kernel, programmable)?;
        Ok(made.map(|pipeline| {
            let pending = pipeline.submit(gpu, &rows);
            Self { probes, stage, pipeline, pending }
        }))
    }

    /// Waits for what came out.
    fn end(self, gpu: &Gpu, probed: &mut Probed) -> Result<(), GpuError> {
        let words = self.pending.wait(gpu)?;
        for (probe, bits) in self.probes.iter().zip(self.pipeline.outputs(words, self.probes.len())) {
            probed.words.push((probe, self.stage, bits));
        }
        Ok(())
    }
}

/// The probes of an attribute: every vertex has the value, and the pixel in the primitive's middle is read.
fn carry(
    gpu: &Gpu,
    shaders: &Shaders,
    flat: bool,
    probes: &[&'static Probe],
    probed: &mut Probed,
) -> Result<(), GpuError> {
    const STAGE: &str = "raster";
    let kind = if flat {
        Raster::Flat { topology: Topology::TriangleList, provoking: Provoking::Last }
    } else {
        Raster::TriangleAttributes
    };
    let pipeline = match RasterPipeline::new(gpu, shaders, kind)? {
        Ok(pipeline) => pipeline,
        Err(reason) => {
            skip(probed, STAGE, reason);
            return Ok(());
        }
    };
    let draw = |&probe: &&'static Probe| {
        let value = f32::from_bits(probe.inputs[0]);
        let row = if flat {
            // Six attributes, the primitive that is looked at, the pixel.
            vec![value, value, value, value, value, value, 0.0, 128.0, 128.0]
        } else {
            let corners = [-1.0, -1.0, 0.5, 1.0, 3.0, -1.0, 0.5, 1.0, -1.0, 3.0, 0.5, 1.0];
            [&corners[..], &[value; 3], &[128.0, 128.0]].concat()
        };
        let drawn = pipeline.submit(gpu, &row);
        (probe, row, drawn)
    };
    let drawn: Vec<_> = probes.iter().map(draw).collect();
    for (probe, row, (count, pending)) in drawn {
        let outputs = pipeline.outputs(&pending.wait(gpu)?, &row, count);
        probed.words.push((probe, STAGE, outputs[0]));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapters::open;
    use lightmeter_catalogue::special::{Class, PROBES};
    use lightmeter_document::event::{Event, Observer, Stop};
    use lightmeter_document::special::SpecialReport;
    use lightmeter_engine::special::run::run;
    use lightmeter_scene::target::SENTINEL;
    use std::collections::BTreeSet;
    use std::sync::atomic::Ordering;

    #[test]
    fn every_function_has_a_probe() {
        let (_, text) = lightmeter_gpu::FILES.into_iter().find(|(name, _)| *name == FILE).expect("it is built in");
        for line in text.lines().filter_map(|line| line.strip_prefix("fn ")) {
            let function = line.split('(').next().unwrap_or_default();
            assert!(PROBES.iter().any(|probe| probe.way == Way::Function(function)), "{function} has no probe");
        }
    }

    #[test]
    fn probes_are_well_formed() {
        let shaders = Shaders::built_in().expect("the built-in shaders are valid");
        let mut names = BTreeSet::new();
        for probe in PROBES {
            assert!(names.insert(probe.name), "{} stands twice", probe.name);
            assert!(probe.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'));
            assert!(!probe.inputs.contains(&SENTINEL), "{}", probe.name);
            match probe.way {
                Way::Function(function) => {
                    let kernel = Kernel::new(&shaders, FILE, function).unwrap_or_else(|error| panic!("{error}"));
                    assert_eq!((kernel.inputs, kernel.outputs), (probe.inputs.len(), 1), "{}", probe.name);
                }
                Way::Varying { .. } => assert_eq!(probe.inputs.len(), 1, "{}", probe.name),
            }
        }
        for class in Class::ALL {
            assert!(PROBES.iter().any(|probe| probe.class == class), "{class:?} has no probe");
        }
    }

    /// Whether an event is the one that the probes are stopped at.
    type IsIt = fn(&Event<'_>) -> bool;

    /// Stops the probes at an event.
    struct StopsAt {
        stop: Stop,
        is_it: IsIt,
    }

    impl Observer for StopsAt {
        fn see(&mut self, event: &Event<'_>) {
            if (self.is_it)(event) {
                self.stop.flag().store(15, Ordering::Relaxed);
            }
        }
    }

    /// What is left of the probes on two devices of one adapter.
    fn stopped_at(is_it: IsIt) -> SpecialReport {
        let first = || open(&[]).unwrap_or_else(|error| panic!("{error}"));
        let subjects: Vec<_> = first().into_iter().chain(first()).collect();
        let code = crate::code(Shaders::built_in().expect("the built-in shaders are valid"));
        let mut observer = StopsAt { stop: Stop::default(), is_it };
        run(&subjects, &code, &observer.stop.clone(), &mut observer).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn no_adapter_is_probed_after_a_stop() {
        if crate::lacks_driver() {
            return;
        }
        // An event, and how many adapters are probed once it stops the probes.
        let rows: [(IsIt, usize); 4] = [
            (|_| false, 2),
            (|event| matches!(event, Event::Begun(_)), 0),
            (|event| matches!(event, Event::Group(_)), 0),
            (|event| matches!(event, Event::Advanced(_)), 1),
        ];
        for (is_it, probed) in rows {
            let report = stopped_at(is_it);
            assert_eq!(report.adapters.len(), probed);
            assert_eq!(report.outcomes.is_empty(), probed == 0);
            let signal = report.interrupted.as_ref().and_then(|interrupted| interrupted.signal);
            assert_eq!((signal, report.is_success()), if probed == 2 { (None, true) } else { (Some(15), false) });
        }
    }
}
