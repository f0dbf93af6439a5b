//! What effects cost that a scene does not call for: composed shaders against the one with all effects.

use lightmeter_document::report::EffectsCost;
use lightmeter_gpu::compose::{Recipe, ShaderForm};
use lightmeter_gpu::scene::SceneRenderer;
use lightmeter_gpu::{Clock, Gpu, GpuError, Shaders};
use lightmeter_scene::effects::Called;
use lightmeter_scene::frame::Frame;

/// Turns that a cost is the median of.
const TURNS: usize = 9;
/// Drawings of a turn.
const REPEATS: u32 = 4;
/// Seconds of a drawing that is long enough by itself.
const SLOW: f64 = 0.05;

/// Draws a frame by composed shaders, and by the one with all effects with the switches of the same effects on, in turns,
/// once both are compiled.
///
/// # Errors
/// Where a shader is invalid or the device fails.
pub(super) fn effects_cost(
    gpu: &Gpu,
    shaders: &Shaders,
    frame: &Frame,
    called: &[Called],
) -> Result<EffectsCost, GpuError> {
    let composed = SceneRenderer::new(gpu, shaders, frame, called, Recipe::of(ShaderForm::Composed))?;
    let full = SceneRenderer::new(gpu, shaders, frame, called, Recipe::of(ShaderForm::Full))?;
    let clock = Clock::wall(None);
    let time = |renderer: &SceneRenderer, repeats: u32| {
        let reading = renderer.time(gpu, &clock, repeats)?;
        Ok::<_, GpuError>(reading.seconds().expect("the clock on the wall goes forward"))
    };
    time(&composed, 1)?;
    time(&full, 1)?;
    let repeats = if time(&full, 1)? > SLOW { 1 } else { REPEATS };
    let mut turns = vec![];
    for turn in 0..TURNS {
        // Each goes first every other time.
        let (a, b) = if turn % 2 == 0 {
            let a = time(&composed, repeats)?;
            (a, time(&full, repeats)?)
        } else {
            let b = time(&full, repeats)?;
            (time(&composed, repeats)?, b)
        };
        turns.push((a, b));
    }
    let sorted = |of: &dyn Fn(&(f64, f64)) -> f64| {
        let mut all: Vec<f64> = turns.iter().map(of).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let milliseconds = |seconds: &[f64]| seconds[TURNS / 2] * 1e3 / f64::from(repeats);
    let ratios = sorted(&|(a, b)| b / a);
    Ok(EffectsCost {
        composed_ms: milliseconds(&sorted(&|(a, _)| *a)),
        full_ms: milliseconds(&sorted(&|(_, b)| *b)),
        ratio: ratios[TURNS / 2],
        quartiles: [ratios[TURNS / 4], ratios[TURNS - 1 - TURNS / 4]],
    })
}
