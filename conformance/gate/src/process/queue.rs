//! All questions of a formula, or a scene, asked until each is answered or has failed. Where the process ends, hangs or floods, the case that
//! it fails at is found.

use super::super::given::Given;
use super::session::{BATCH, Ended, Question, Questions, Session};
use lightmeter_catalogue::cases::Stage;
use lightmeter_judge::cases::Unanswered;
use std::collections::VecDeque;
use std::time::Duration;

/// Failed starts in a row after which nothing more is asked.
const MOST_STARTS: usize = 3;
/// Crashes and hangs after which nothing more is asked.
const MOST_CRASHES: u64 = 100;
/// Cases of a formula that it may end or hang at before no more of that formula is asked.
pub(super) const MOST_OF_FORMULA: usize = 3;

/// What is still to be asked of a process, by the places of the questions.
struct Queue<'a> {
    questions: Questions<'a>,
    open: VecDeque<usize>,
    /// Cases that are asked alone, to find the one that it fails at.
    alone: usize,
    /// What was told of them, by its places among the incidents, as long as the culprit is not found.
    untold: Vec<usize>,
    /// Since when they are asked so, where it was said to take too long.
    since: Option<Duration>,
}

impl Queue<'_> {
    /// The cases that are asked next, `size` at once at most.
    fn next(&self, size: usize) -> Vec<usize> {
        let count = if self.alone > 0 { 1 } else { size };
        self.open.iter().take(count).copied().collect()
    }
}

impl Session {
    /// Asks questions, which are of one formula or a scene, until each is answered or has failed. What is not asked is said to be so.
    pub(super) fn all(&mut self, questions: &[Question<'_>], advanced: &mut dyn FnMut(u64)) -> Vec<Given> {
        let open = (0..questions.len()).collect();
        let questions = Questions::new(questions);
        let mut queue = Queue { questions, open, alone: 0, untold: vec![], since: None };
        while !queue.open.is_empty() && !self.has_broken_off && !self.has_given_up(&queue) {
            if self.running.is_none() && !self.starts_again(queue.open.len()) {
                self.has_broken_off = true;
                break;
            }
            let batch = queue.next(self.size);
            let (ended, rest) = self.batch(&mut queue.questions, &batch);
            let done = batch.len() - rest.len();
            self.answered += done;
            advanced(done as u64);
            queue.open.drain(..batch.len());
            queue.alone = queue.alone.saturating_sub(done);
            match ended {
                Ended::Answered => self.forgets_culprit(&mut queue),
                Ended::OutOfTime | Ended::Stopped => self.breaks_off(ended),
                Ended::Crashed | Ended::Hung | Ended::Flooded | Ended::Deaf => self.failed(&mut queue, ended, rest),
            }
        }
        queue.questions.given.into_iter().map(|given| given.unwrap_or(Given::Nothing(Unanswered::Unasked))).collect()
    }

    /// Where all cases that were asked alone are answered, there is no culprit. Together they may take longer than one of them
    /// may: that is no hang.
    fn forgets_culprit(&mut self, queue: &mut Queue<'_>) {
        if queue.alone > 0 {
            return;
        }
        let limit = self.asking.limits.case;
        if queue.since.take().is_some_and(|since| (self.clock.now() - since) * 2 >= limit) {
            queue.untold.drain(..).rev().for_each(|place| drop(self.used.incidents.remove(place)));
        }
        queue.untold.clear();
    }

    /// Ends the process before all was asked; nothing more is asked.
    pub(super) fn breaks_off(&mut self, ended: Ended) {
        self.kill(ended);
        self.used.incidents.push(format!("{}: what was left was not asked, or not answered", ended.message()));
        self.has_broken_off = true;
    }

    /// Ends a process that failed with cases open, and finds out which of them it failed at.
    fn failed(&mut self, queue: &mut Queue<'_>, ended: Ended, rest: Vec<usize>) {
        let cut =
            self.running.as_ref().filter(|_| ended == Ended::Hung).and_then(|running| running.framing.cut_short());
        let message = cut.map_or_else(|| ended.message().to_owned(), |cut| format!("{}: {cut}", ended.message()));
        let how = self.kill(ended);
        let [culprit] = rest[..] else {
            // A retry hides nothing: that the process ended is reported, whatever it answers afterwards.
            let count = rest.len();
            queue.untold = vec![self.used.incidents.len()];
            queue.since = (ended == Ended::Hung).then(|| self.clock.now());
            let incident = format!("with {count} cases open {message}: {how}; they are asked one by one");
            self.used.incidents.push(incident);
            self.size = BATCH[0];
            queue.alone = count;
            rest.into_iter().rev().for_each(|place| queue.open.push_front(place));
            return;
        };
        let id = &queue.questions.all[culprit].id;
        if ended == Ended::Crashed && self.answered > 0 {
            // It may be an earlier case that it ended of: one that it is asked first is the culprit.
            queue.untold.push(self.used.incidents.len());
            self.used.incidents.push(format!("before it answered {id} {message}: {how}; it is asked again"));
            queue.alone = queue.alone.max(1);
            queue.open.push_front(culprit);
            return;
        }
        // The case that ended the process is found: what was kept for its batch is reported of it alone.
        queue.alone = queue.alone.saturating_sub(1);
        queue.since = None;
        for place in std::mem::take(&mut queue.untold).into_iter().rev() {
            self.used.incidents.remove(place);
        }
        let is_expected =
            self.expected.iter().any(|expected| expected.known.crash && expected.has(id, &[Stage::Answer.name()]));
        let message = format!("{message}: {how}");
        let incidents = if is_expected { &mut self.used.expected_incidents } else { &mut self.used.incidents };
        incidents.push(format!("{id}: {message}"));
        queue.questions.given[culprit] = Some(Given::Nothing(Unanswered::Broken(message)));
        if !is_expected {
            self.culprits += 1;
            self.gives_up(queue, culprit);
        }
        if self.culprits >= MOST_CRASHES {
            self.used.incidents.push(format!("{MOST_CRASHES} crashes and hangs: nothing more is asked"));
            self.has_broken_off = true;
        }
    }

    /// After a few cases of a formula that it ended or hung at, asks no more of that formula.
    fn gives_up(&mut self, queue: &Queue<'_>, culprit: usize) {
        let Some(group) = queue.questions.all[culprit].asks.group() else { return };
        let culprits = self.culprits_of.entry(group.clone()).or_default();
        *culprits += 1;
        if *culprits == MOST_OF_FORMULA {
            let left = queue.open.len();
            let what = format!("{group}: no more of it is asked after {MOST_OF_FORMULA} such cases; {left} are left");
            self.used.incidents.push(what);
        }
    }

    /// Whether no more of the questions' formula is asked.
    fn has_given_up(&self, queue: &Queue<'_>) -> bool {
        let group = queue.questions.all.first().and_then(|question| question.asks.group());
        group.and_then(|group| self.culprits_of.get(&group)).is_some_and(|culprits| *culprits >= MOST_OF_FORMULA)
    }

    /// Starts the process once more, or tells that it will not.
    pub(super) fn starts_again(&mut self, left: usize) -> bool {
        let mut started = self.start();
        for _ in 1..MOST_STARTS {
            if started.is_err() && !self.is_stopped() {
                started = self.start();
            }
        }
        let Err(error) = started else { return true };
        // It was there once, and is no more.
        self.used.incidents.push(format!("{error}; {left} cases of what was asked next are left"));
        false
    }
}
