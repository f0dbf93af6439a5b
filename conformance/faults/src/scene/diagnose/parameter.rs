//! Wrong parameters of a frame: a number that is some factor times what it should be.

use super::super::draw_at;
use super::{Made, Near, Trial, nearest_first, spread};
use lightmeter_document::report::WrongParameter;
use lightmeter_scene::frame::{FogForm, Frame, Place};
use rayon::prelude::*;

/// Parameters whose factor is looked for between those that are tried.
const REFINED: usize = 3;
/// How often the factor's neighbourhood is narrowed, to 0.6 of what it was each time.
const NARROWED: usize = 18;
/// Components of the failing and of the passing pixels that a factor is found by.
const FITTED: usize = 96;

/// A number of a frame that may be wrong.
#[derive(Debug)]
pub(super) struct Parameter {
    /// What it is, as the beginning of a sentence.
    says: &'static str,
    /// Multiplies it by a factor.
    scale: fn(&mut Frame, f32),
}

/// Factors that differ from 1 by less than this many per cent are reported as a difference ("0.3 % larger") rather than as a factor.
const LITTLE: f64 = 10.0;
/// The number of distinguishable factors, for each tried factor, at which the search around it may end. It counts toward the number of
/// candidates that evidence has to beat.
pub(super) const STEPS: usize = 256;

/// A parameter with the factor that it is wrong by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scaled {
    pub(super) parameter: &'static Parameter,
    pub(super) factor: f32,
}

impl Scaled {
    /// The frame with the wrong parameter.
    pub(super) fn frame(self, frame: &Frame) -> Frame {
        let mut frame = frame.clone();
        (self.parameter.scale)(&mut frame, self.factor);
        frame
    }

    /// As a report has it.
    pub(super) fn told(self) -> WrongParameter {
        let says = self.parameter.says;
        let name = says.strip_suffix(" is").or(says.strip_suffix(" are")).unwrap_or(says);
        WrongParameter { names: vec![name.to_owned()], factor: self.factor.into() }
    }

    /// It in words.
    pub(super) fn says(self) -> String {
        let more = 100.0 * (f64::from(self.factor) - 1.0);
        if more.abs() < LITTLE {
            let (size, which) = (more.abs(), if more < 0.0 { "smaller" } else { "larger" });
            return format!("{} {size:.2} % {which} than what was asked", self.parameter.says);
        }
        let digits = match self.factor {
            factor if factor < 0.1 => 4,
            factor if factor < 10.0 => 3,
            _ => 1,
        };
        let factor = format!("{:.digits$}", self.factor);
        let factor = factor.trim_end_matches('0').trim_end_matches('.');
        format!("{} {factor} times what was asked", self.parameter.says)
    }
}

/// Factors that real mistakes have, tried as they are: the others are found from the nearest of them.
pub(super) const FACTORS: [f32; 14] = [
    0.125,
    0.25,
    std::f32::consts::FRAC_1_PI,
    0.5,
    2.0 / 3.0,
    0.8,
    0.9,
    1.1,
    1.25,
    1.5,
    2.0,
    std::f32::consts::PI,
    4.0,
    8.0,
];

impl Trial<'_> {
    /// The parameters that may be wrong, each with the factor that comes nearest, the nearest first.
    pub(super) fn scaled(&self) -> Vec<Near> {
        let tried = |(parameter, factor)| Scaled { parameter, factor };
        let all: Vec<Scaled> =
            PARAMETERS.iter().flat_map(|one| FACTORS.iter().map(move |&factor| tried((one, factor)))).collect();
        let is_change = |scaled: &Scaled| scaled.frame(self.frame) != *self.frame;
        let mut found: Vec<(f64, Scaled)> =
            all.into_par_iter().filter(is_change).map(|scaled| (self.apart(scaled), scaled)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut parameters: Vec<*const _> = vec![];
        found.retain(|(_, scaled)| {
            let is_first = !parameters.contains(&std::ptr::from_ref(scaled.parameter));
            parameters.push(std::ptr::from_ref(scaled.parameter));
            is_first
        });
        let refined = found.into_iter().take(REFINED).flat_map(|(_, scaled)| [scaled, self.refined(scaled)]);
        let made = refined.map(|scaled| Made { faults: vec![], scaled: Some(scaled) });
        nearest_first(made.collect::<Vec<_>>().into_par_iter().filter_map(|made| self.probe(made)).collect())
    }

    /// How far the image is from one with a wrong parameter, in units, at some components.
    fn apart(&self, scaled: Scaled) -> f64 {
        let looked: Vec<(usize, usize)> =
            spread(&self.failing_there, FITTED).chain(spread(&self.passing_there, FITTED)).collect();
        let pixels: Vec<usize> = looked.iter().map(|&(place, _)| self.looked_at[place]).collect();
        let drawn = draw_at(&scaled.frame(self.frame), &[], &pixels);
        looked
            .iter()
            .zip(&pixels)
            .zip(&drawn)
            .map(|((&(_, k), &number), drawn)| (self.image.pixels[number][k] - drawn[k]).abs())
            // What is no number is far from everything alike.
            .filter(|apart| apart.is_finite())
            .sum()
    }

    /// The factor near this one that comes nearest, by the golden section of its logarithm.
    fn refined(&self, scaled: Scaled) -> Scaled {
        let golden = 0.5 * (5.0_f32.sqrt() - 1.0);
        let middle = scaled.factor.ln();
        let (mut low, mut high) = (middle - std::f32::consts::LN_2, middle + std::f32::consts::LN_2);
        let at = |log: f32| Scaled { factor: log.exp(), ..scaled };
        let mut inner = [high - golden * (high - low), low + golden * (high - low)];
        let mut apart = inner.map(|log| self.apart(at(log)));
        for _ in 0..NARROWED {
            if apart[0] <= apart[1] {
                high = inner[1];
                inner = [high - golden * (high - low), inner[0]];
                apart = [self.apart(at(inner[0])), apart[0]];
            } else {
                low = inner[0];
                inner = [inner[1], low + golden * (high - low)];
                apart = [apart[1], self.apart(at(inner[1]))];
            }
        }
        at(inner[usize::from(apart[1] < apart[0])])
    }
}

fn times<const N: usize>(numbers: &mut [f32; N], factor: f32) {
    numbers.iter_mut().for_each(|x| *x *= factor);
}

fn each_falloff(frame: &mut Frame, change: impl Fn(&mut [f32; 3])) {
    for light in &mut frame.lights {
        if let Place::Point { falloff, .. } | Place::Spot { falloff, .. } = &mut light.place {
            change(falloff);
        }
    }
}

/// All of them. None is another one's double: a light's colour times a material's is scaled once.
pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        says: "all light is",
        scale: |frame, factor| {
            times(&mut frame.ambient, factor);
            for light in &mut frame.lights {
                times(&mut light.ambient, factor);
                times(&mut light.diffuse, factor);
                times(&mut light.specular, factor);
            }
            frame.draws.iter_mut().for_each(|draw| times(&mut draw.material.emissive, factor));
        },
    },
    Parameter { says: "the ambient light is", scale: |frame, factor| times(&mut frame.ambient, factor) },
    Parameter {
        says: "the lights' own ambient terms are",
        scale: |frame, factor| frame.lights.iter_mut().for_each(|light| times(&mut light.ambient, factor)),
    },
    Parameter {
        says: "the diffuse term is",
        scale: |frame, factor| frame.lights.iter_mut().for_each(|light| times(&mut light.diffuse, factor)),
    },
    Parameter {
        says: "the highlight is",
        scale: |frame, factor| frame.lights.iter_mut().for_each(|light| times(&mut light.specular, factor)),
    },
    Parameter {
        says: "the emission is",
        scale: |frame, factor| frame.draws.iter_mut().for_each(|draw| times(&mut draw.material.emissive, factor)),
    },
    Parameter {
        says: "the shininess is",
        scale: |frame, factor| frame.draws.iter_mut().for_each(|draw| draw.material.shininess *= factor),
    },
    Parameter {
        says: "attenuation's linear coefficient is",
        scale: |frame, factor| each_falloff(frame, |falloff| falloff[1] *= factor),
    },
    Parameter {
        says: "attenuation's quadratic coefficient is",
        scale: |frame, factor| each_falloff(frame, |falloff| falloff[2] *= factor),
    },
    Parameter {
        says: "a spotlight's exponent is",
        scale: |frame, factor| {
            for light in &mut frame.lights {
                if let Place::Spot { exponent, .. } = &mut light.place {
                    *exponent *= factor;
                }
            }
        },
    },
    Parameter {
        says: "a spotlight's cutoff angle is",
        scale: |frame, factor| {
            for light in &mut frame.lights {
                if let Place::Spot { cutoff_cosine, .. } = &mut light.place {
                    *cutoff_cosine = (factor * cutoff_cosine.acos()).min(std::f32::consts::PI).cos();
                }
            }
        },
    },
    Parameter {
        says: "the fog's density is",
        scale: |frame, factor| {
            if let Some(fog) = &mut frame.fog
                && let FogForm::Exp { density } | FogForm::Exp2Document { density } | FogForm::Exp2OpenGl { density } =
                    &mut fog.form
            {
                *density *= factor;
            }
        },
    },
    Parameter {
        says: "the distance where linear fog begins is",
        scale: |frame, factor| {
            if let Some(fog) = &mut frame.fog
                && let FogForm::Linear { dmin, .. } = &mut fog.form
            {
                *dmin *= factor;
            }
        },
    },
    Parameter {
        says: "the distance where linear fog ends is",
        scale: |frame, factor| {
            if let Some(fog) = &mut frame.fog
                && let FogForm::Linear { dmax, .. } = &mut fog.form
            {
                *dmax *= factor;
            }
        },
    },
    Parameter { says: "alpha is", scale: |frame, factor| frame.draws.iter_mut().for_each(|draw| draw.alpha *= factor) },
];
