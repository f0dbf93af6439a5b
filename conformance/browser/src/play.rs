//! Shaders that a page hands over as somebody types, and what becomes of them.

use serde::{Deserialize, Serialize};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A shader that a page hands over to be judged.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlayedShader {
    /// Its language.
    pub language: PlayedLanguage,
    /// Its text.
    pub text: String,
    /// The function that is judged; empty for the shader as a whole.
    pub function: String,
    /// The formula that it is judged by; empty for the one that it is nearest to.
    pub formula: String,
    /// What variables mean, each as `NAME=EXPRESSION`.
    pub bind: Vec<String>,
    /// Inputs that are constants, each as `NAME=VALUE`.
    pub constant: Vec<String>,
}

/// A language that shaders are written in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlayedLanguage {
    /// WGSL.
    #[default]
    Wgsl,
    /// GLSL.
    Glsl,
}

/// What became of a shader.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PlayedResult {
    /// Why it was not judged.
    pub refused: Option<String>,
    /// What its variables were taken to be.
    pub told: String,
    /// The formulas that it was judged by, the nearest one first.
    pub formulas: Vec<PlayedFormula>,
    /// The whole result in words.
    pub result: String,
    /// What the nearest formula draws, by the reference and by the shader.
    pub picture: Option<PlayedPicture>,
}

/// The verdict by one formula.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlayedFormula {
    /// The formula.
    pub id: String,
    /// Verdicts.
    pub verdicts: u64,
    /// Verdicts that failed.
    pub failed: u64,
    /// The mistake that explains them, or what else is wrong.
    pub why: Option<String>,
    /// Outputs of the formula that the shader does not give.
    pub missing: Vec<String>,
}

/// The same picture by the reference and by the shader, and where they differ.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlayedPicture {
    /// What it shows.
    pub caption: String,
    /// Reference, result and error map, as the addresses of images that hold them.
    pub files: [String; 3],
    /// Pixels that are wrong.
    pub wrong: usize,
    /// Pixels that are drawn.
    pub drawn: usize,
}

/// What came of asking.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum PlayReply {
    /// The result, as JSON.
    Done(String),
    /// A later shader came before it was its turn.
    Superseded,
    /// Nobody judges shaders, or it takes too long.
    Late,
    /// No shaders are judged any more.
    Over,
}

/// The shaders of one page: at most one waits, as people look at the last one.
#[derive(Debug, Default)]
pub(crate) struct Plays {
    state: Mutex<PlaysState>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct PlaysState {
    /// The number of the last one that was asked.
    last: u64,
    waiting: Option<(u64, PlayedShader)>,
    under_way: Option<u64>,
    done: Option<(u64, String)>,
    is_over: bool,
}

impl Plays {
    fn state(&self) -> MutexGuard<'_, PlaysState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until something holds, and not for longer than that.
    fn until<T>(&self, patience: Duration, mut holds: impl FnMut(&mut PlaysState) -> Option<T>) -> Option<T> {
        let until = Instant::now() + patience;
        let mut state = self.state();
        loop {
            if let Some(found) = holds(&mut state) {
                return Some(found);
            }
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return None;
            }
            state = self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Has a shader judged, in the place of one that still waits.
    pub(crate) fn ask(&self, shader: PlayedShader, patience: Duration) -> PlayReply {
        let number = {
            let mut state = self.state();
            state.last += 1;
            if state.is_over {
                return PlayReply::Over;
            }
            state.waiting = Some((state.last, shader));
            state.last
        };
        self.changed.notify_all();
        let replied = self.until(patience, |state| {
            if let Some((_, result)) = state.done.as_ref().filter(|(done, _)| *done == number) {
                return Some(PlayReply::Done(result.clone()));
            }
            if state.is_over {
                return Some(PlayReply::Over);
            }
            let is_kept = state.under_way == Some(number) || state.waiting.as_ref().is_some_and(|(k, _)| *k == number);
            (!is_kept).then_some(PlayReply::Superseded)
        });
        replied.unwrap_or(PlayReply::Late)
    }

    /// The shader that is judged next.
    pub(crate) fn next(&self, patience: Duration) -> Option<PlayedShader> {
        self.until(patience, |state| {
            let (number, shader) = state.waiting.take()?;
            state.under_way = Some(number);
            Some(shader)
        })
    }

    /// Notes that no shader is judged any more.
    pub(crate) fn end(&self) {
        self.state().is_over = true;
        self.changed.notify_all();
    }

    /// Notes what became of the shader under way.
    pub(crate) fn done(&self, result: &PlayedResult) {
        let text = serde_json::to_string(result).unwrap_or_default();
        let mut state = self.state();
        state.done = state.under_way.take().map(|number| (number, text));
        self.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    const LONG: Duration = Duration::from_secs(600);

    fn shader(text: &str) -> PlayedShader {
        PlayedShader { text: text.into(), ..PlayedShader::default() }
    }

    #[test]
    fn a_shader_that_waits_gives_way_to_a_later_one() {
        let plays = Arc::new(Plays::default());
        let asked = |text: &str| {
            let (plays, shader) = (plays.clone(), shader(text));
            std::thread::spawn(move || plays.ask(shader, LONG))
        };
        let is_asked = |last: u64| {
            assert!(plays.until(LONG, |state| (state.last == last).then_some(())).is_some(), "{last} is asked");
        };
        let first = asked("first");
        assert_eq!(plays.next(LONG), Some(shader("first")));
        let second = asked("second");
        is_asked(2);
        let third = asked("third");
        is_asked(3);
        assert_eq!(second.join().expect("it ends"), PlayReply::Superseded);
        plays.done(&PlayedResult { told: "one".into(), ..PlayedResult::default() });
        let PlayReply::Done(text) = first.join().expect("it ends") else { panic!("the first was under way") };
        assert!(text.contains("\"one\""), "{text}");
        assert_eq!(plays.next(LONG), Some(shader("third")));
        plays.done(&PlayedResult::default());
        assert!(matches!(third.join().expect("it ends"), PlayReply::Done(_)));
    }

    #[test]
    fn who_waits_hears_of_the_end() {
        let plays = Arc::new(Plays::default());
        let waiting = {
            let plays = plays.clone();
            std::thread::spawn(move || plays.ask(shader("x"), LONG))
        };
        assert!(plays.next(LONG).is_some());
        plays.end();
        assert_eq!(waiting.join().expect("it ends"), PlayReply::Over);
        assert_eq!(plays.ask(shader("y"), LONG), PlayReply::Over);
    }

    #[test]
    fn nobody_waits_for_ever() {
        let plays = Plays::default();
        assert_eq!(plays.ask(shader("x"), Duration::from_millis(1)), PlayReply::Late);
        assert_eq!(plays.next(Duration::ZERO), Some(shader("x")), "it may still be judged");
        assert_eq!(plays.next(Duration::ZERO), None);
    }
}
