//! The work of one browser: pieces on their way to its page, and what came of them.

use crate::play::{PlayReply, PlayedResult, PlayedShader, Plays};
use lightmeter_gpu::{Abilities, Host, HostError, Ticket, WorkPiece};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long a piece of work may take.
const PATIENCE: Duration = Duration::from_secs(300);
/// How long a page may be silent before it is taken for gone.
const SILENCE: Duration = Duration::from_secs(60);
/// How long a page that was closed may take to be loaded again.
const RELOAD: Duration = Duration::from_secs(10);
/// How long the end of a run waits for a page to hear of it.
const GOODBYE: Duration = Duration::from_secs(3);
/// Bytes of pieces that are handed over at once, at most, but for one that is longer.
const AT_ONCE: usize = 8 << 20;
/// Pictures that a page is shown, at most.
const PICTURES_MOST: usize = 96;
/// The protocol's version, which page and server must have in common.
pub(crate) const PROTOCOL: u32 = 1;
/// How often a device may be lost at the same piece of work.
const LOSSES: u32 = 2;

/// What a page says of itself.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BrowserHello {
    /// The version of the protocol that it speaks.
    pub protocol: u32,
    /// The session that it had before it was loaded again.
    pub session: Option<String>,
    /// The GPU's vendor, as `nvidia`.
    pub vendor: String,
    /// The GPU's architecture, as `ampere`.
    pub architecture: String,
    /// The GPU's model; most browsers keep it to themselves.
    pub model: String,
    /// The GPU in words; most browsers keep it to themselves.
    pub description: String,
    /// The operating system.
    pub platform: String,
    /// The browser.
    pub browser: String,
    /// The browser's version.
    pub version: String,
    /// What the device can do.
    pub abilities: Abilities,
}

impl BrowserHello {
    /// The GPU's name: its description or model where the browser tells one, and otherwise its vendor and architecture.
    #[must_use]
    pub fn device(&self) -> String {
        let own = [&self.description, &self.model].into_iter().find(|text| !text.is_empty());
        let parts: Vec<&str> = match own {
            Some(own) => vec![own],
            None => [&self.vendor, &self.architecture]
                .into_iter()
                .map(String::as_str)
                .filter(|text| !text.is_empty())
                .collect(),
        };
        if parts.is_empty() { "a GPU of which the browser tells nothing".into() } else { parts.join(" ") }
    }

    /// The browser, its version and its system. A browser does not tell the version of the driver.
    #[must_use]
    pub fn driver(&self) -> String {
        format!("{} {} on {}", self.browser, self.version, self.platform)
    }
}

/// A browser that answers, with the work that it has.
#[derive(Debug)]
pub struct Session {
    pub(crate) id: String,
    hello: BrowserHello,
    state: Mutex<State>,
    changed: Condvar,
    board: Mutex<Board>,
    plays: Plays,
}

/// How far a run has come, as its page shows it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PageState {
    /// In words.
    pub says: String,
    /// Cases that are judged.
    pub done: u64,
    /// Of so many; 0 where it is not known.
    pub of: u64,
    /// Groups that failed.
    pub failed: u64,
    /// Whether the run is over.
    pub is_over: bool,
    /// What was judged, one after the other.
    pub groups: Vec<PageGroup>,
    /// The formulas that shaders typed into the page are judged by; empty where the page takes none.
    pub playground: Vec<String>,
}

/// The verdicts on one formula or scene, as a page shows them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PageGroup {
    /// Its id.
    pub id: String,
    /// The stage, or the target.
    pub stage: String,
    /// Verdicts.
    pub verdicts: u64,
    /// Verdicts that failed.
    pub failed: u64,
    /// Why they did, where that is known.
    pub why: Option<String>,
    /// The number of the first of its three pictures, reference, result and error map, where it has some.
    pub picture: Option<usize>,
}

/// How far the run has come, and the reports that the page may take at its end.
#[derive(Debug, Default)]
struct Board {
    told: PageState,
    /// PNG files.
    pictures: Vec<Vec<u8>>,
    /// As a page and as JSON.
    reports: Option<[String; 2]>,
    /// Whether the page knows that the run is over.
    is_known: bool,
}

/// A page's request came too late: another page has the session.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Superseded;

#[derive(Debug)]
struct State {
    next: u64,
    /// Pieces that nothing came of yet, by their numbers.
    open: BTreeMap<u64, Open>,
    /// What made that which executors keep: a new page is handed it again.
    kept: BTreeMap<u64, Open>,
    answers: HashMap<u64, Result<Vec<u8>, HostError>>,
    /// Pieces whose results nobody waits for.
    forgotten: HashSet<u64>,
    /// Executors that were dropped: nothing is kept of them any more.
    dropped: HashSet<u64>,
    /// The number of the page that has the session.
    page: u64,
    /// When the page is taken for gone, unless it is heard of before.
    gone_at: Instant,
    /// The first open piece when the device was lost, and how often it was.
    lost_at: (u64, u32),
    /// Why no more will come.
    ended: Option<String>,
}

/// A piece of work that the page was or is to be handed.
#[derive(Clone, Debug)]
struct Open {
    executor: u64,
    role: Role,
    bytes: Arc<[u8]>,
}

/// What a piece is to later pages, and whether something comes back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// Makes what is kept.
    Makes,
    /// Changes what is kept; nothing comes back.
    Changes,
    /// Ends what is kept; nothing comes back.
    Ends,
    /// Is done once.
    Once,
}

impl Session {
    pub(crate) fn new(id: String, hello: BrowserHello) -> Self {
        let state = State {
            next: 1,
            open: BTreeMap::new(),
            kept: BTreeMap::new(),
            answers: HashMap::new(),
            forgotten: HashSet::new(),
            dropped: HashSet::new(),
            page: 0,
            gone_at: Instant::now() + SILENCE,
            lost_at: (0, 0),
            ended: None,
        };
        Self {
            id,
            hello,
            state: Mutex::new(state),
            changed: Condvar::new(),
            board: Mutex::default(),
            plays: Plays::default(),
        }
    }

    /// What the page said of itself.
    #[must_use]
    pub const fn hello(&self) -> &BrowserHello {
        &self.hello
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Hands the session to a page, which is given all that is open and kept. Its number.
    pub(crate) fn take_over(&self) -> u64 {
        let mut state = self.state();
        state.page += 1;
        state.gone_at = Instant::now() + SILENCE;
        self.changed.notify_all();
        state.page
    }

    /// Notes that a page is there.
    pub(crate) fn see(&self, page: u64) -> Result<(), Superseded> {
        let mut state = self.state();
        state.is_of(page)?;
        state.gone_at = Instant::now() + SILENCE;
        Ok(())
    }

    /// Notes that a page was closed, which may be because it is loaded again.
    pub(crate) fn leave(&self, page: u64) -> Result<(), Superseded> {
        let mut state = self.state();
        state.is_of(page)?;
        state.gone_at = Instant::now() + RELOAD;
        Ok(())
    }

    /// The pieces after one, each with its number and length before it; waits for some, and gives none where none come.
    pub(crate) fn after(&self, page: u64, after: u64, patience: Duration) -> Result<Vec<u8>, Superseded> {
        let until = Instant::now() + patience;
        let mut state = self.state();
        state.is_of(page)?;
        state.gone_at = Instant::now() + SILENCE;
        loop {
            state.is_of(page)?;
            let handed = state.handed(after);
            let left = until.saturating_duration_since(Instant::now());
            if !handed.is_empty() || left.is_zero() || state.ended.is_some() {
                return Ok(handed);
            }
            state = self.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Takes what came of a piece. What came of it before is left as it is.
    pub(crate) fn answer(&self, page: u64, id: u64, result: Result<Vec<u8>, HostError>) -> Result<(), Superseded> {
        let mut state = self.state();
        state.is_of(page)?;
        state.gone_at = Instant::now() + SILENCE;
        state.close(id, result);
        self.changed.notify_all();
        Ok(())
    }

    /// Notes that the page lost its device. A piece at which that happens again has failed.
    pub(crate) fn lose(&self, page: u64, message: &str) -> Result<(), Superseded> {
        let mut state = self.state();
        state.is_of(page)?;
        let first = state.open.iter().find(|(_, open)| open.role != Role::Ends).map_or(0, |(id, _)| *id);
        let times = if state.lost_at.0 == first { state.lost_at.1 + 1 } else { 1 };
        state.lost_at = (first, times);
        if times >= LOSSES {
            state.close(first, Err(HostError::Failed(format!("device lost: {message}"))));
        }
        self.changed.notify_all();
        Ok(())
    }

    fn board(&self) -> MutexGuard<'_, Board> {
        self.board.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes what the page is told.
    pub fn tell(&self, change: impl FnOnce(&mut PageState)) {
        change(&mut self.board().told);
    }

    /// The next shader that was typed into the page; `None` where none comes in time.
    #[must_use]
    pub fn next_shader(&self, patience: Duration) -> Option<PlayedShader> {
        self.plays.next(patience)
    }

    /// Hands over what became of that shader.
    pub fn tell_of_shader(&self, result: &PlayedResult) {
        self.plays.done(result);
    }

    /// Has a shader judged, and waits for the result.
    pub(crate) fn play(&self, shader: PlayedShader, patience: Duration) -> PlayReply {
        self.plays.ask(shader, patience)
    }

    /// Whether nothing is to be expected of the browser any more.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.state().ended.is_some()
    }

    /// The same, where nothing is asked of the browser: a page that is silent for too long is gone.
    #[must_use]
    pub fn is_gone(&self) -> bool {
        let mut state = self.state();
        state.note_silence();
        state.ended.is_some()
    }

    /// Keeps pictures for the page, as PNG files. Gives the number of the first; `None` where there are enough.
    #[must_use]
    pub fn show(&self, pictures: Vec<Vec<u8>>) -> Option<usize> {
        let mut board = self.board();
        let first = board.pictures.len();
        if pictures.is_empty() || first + pictures.len() > PICTURES_MOST {
            return None;
        }
        board.pictures.extend(pictures);
        Some(first)
    }

    /// One of them.
    pub(crate) fn picture(&self, number: usize) -> Option<Vec<u8>> {
        self.board().pictures.get(number).cloned()
    }

    /// Tells the page that the run is over, in words, and gives it the report as a page and as JSON. Waits until the page knows, but not for long.
    pub fn tell_the_end(&self, says: String, reports: Option<[String; 2]>) {
        let mut board = self.board();
        board.told.says = says;
        board.told.is_over = true;
        board.reports = reports;
        drop(board);
        self.plays.end();
        let until = Instant::now() + GOODBYE;
        while !self.board().is_known && self.state().ended.is_none() && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// What the page is told, with the groups from one on.
    pub(crate) fn told(&self, from: usize) -> PageState {
        let mut board = self.board();
        board.is_known |= board.told.is_over && board.reports.is_none();
        let PageState { ref says, done, of, failed, is_over, ref groups, ref playground } = board.told;
        PageState {
            says: says.clone(),
            done,
            of,
            failed,
            is_over,
            groups: groups.get(from..).unwrap_or_default().to_vec(),
            playground: playground.clone(),
        }
    }

    /// The report as a page, once there is one.
    pub(crate) fn page(&self) -> Option<String> {
        Some(self.board().reports.as_ref()?[0].clone())
    }

    /// The report as JSON, once there is one; it is what a page takes last.
    pub(crate) fn json(&self) -> Option<String> {
        let mut board = self.board();
        board.is_known |= board.reports.is_some();
        Some(board.reports.as_ref()?[1].clone())
    }

    /// Ends the session: nothing is waited for any more.
    pub(crate) fn end(&self, why: &str) {
        self.state().ended.get_or_insert_with(|| why.into());
        self.changed.notify_all();
        self.plays.end();
    }
}

impl State {
    const fn is_of(&self, page: u64) -> Result<(), Superseded> {
        if self.page == page { Ok(()) } else { Err(Superseded) }
    }

    /// Ends the session where its page is silent for too long.
    fn note_silence(&mut self) {
        if Instant::now() > self.gone_at {
            self.ended
                .get_or_insert_with(|| "the browser is silent: its page was closed, or its machine sleeps".to_owned());
        }
    }

    fn handed(&mut self, after: u64) -> Vec<u8> {
        let mut pieces: Vec<(u64, Open)> = [&self.kept, &self.open]
            .into_iter()
            .flat_map(|pieces| pieces.range(after + 1..).map(|(id, open)| (*id, open.clone())))
            .collect();
        pieces.sort_by_key(|(id, _)| *id);
        let mut handed = vec![];
        for (id, Open { role, bytes, .. }) in pieces {
            let length = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
            if !handed.is_empty() && handed.len() + bytes.len() > AT_ONCE {
                break;
            }
            handed.extend(id.to_le_bytes());
            handed.extend(length.to_le_bytes());
            handed.extend(&*bytes);
            if role == Role::Ends {
                self.open.remove(&id);
            }
        }
        handed
    }

    fn close(&mut self, id: u64, result: Result<Vec<u8>, HostError>) {
        let Some(open) = self.open.remove(&id) else { return };
        if open.role == Role::Makes && !self.dropped.contains(&open.executor) {
            // Where something was refused, the others of the same piece have their places all the same.
            self.kept.insert(id, open);
        }
        if !self.forgotten.remove(&id) {
            self.answers.insert(id, result);
        }
    }
}

impl Host for Session {
    fn abilities(&self) -> Abilities {
        self.hello.abilities.clone()
    }

    fn send(&self, piece: &WorkPiece<'_>) -> Ticket {
        let mut bytes = vec![];
        ciborium::into_writer(piece, &mut bytes).expect("a description is written to memory");
        let (executor, role) = match *piece {
            WorkPiece::Make { executor, .. } => (executor, Role::Makes),
            WorkPiece::ForgetPipelines { executor } => (executor, Role::Changes),
            WorkPiece::Drop { executor } => (executor, Role::Ends),
            WorkPiece::Submit { executor, .. } | WorkPiece::Time { executor, .. } => (executor, Role::Once),
            WorkPiece::Destroy => (u64::MAX, Role::Ends),
        };
        let mut state = self.state();
        let id = state.next;
        state.next += 1;
        if role == Role::Ends {
            state.kept.retain(|_, kept| kept.executor != executor);
            state.dropped.insert(executor);
        }
        let open = Open { executor, role, bytes: bytes.into() };
        if role == Role::Changes { &mut state.kept } else { &mut state.open }.insert(id, open);
        self.changed.notify_all();
        Ticket(id)
    }

    fn wait(&self, ticket: Ticket) -> Result<Vec<u8>, HostError> {
        let until = Instant::now() + PATIENCE;
        let mut state = self.state();
        loop {
            if let Some(result) = state.answers.remove(&ticket.0) {
                return result;
            }
            if let Some(why) = &state.ended {
                return Err(HostError::Failed(why.clone()));
            }
            state.note_silence();
            if state.ended.is_some() {
                continue;
            }
            if Instant::now() > until {
                return Err(HostError::Silent(PATIENCE.as_secs()));
            }
            state = self.changed.wait_timeout(state, Duration::from_secs(1)).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn forget(&self, ticket: Ticket) {
        let mut state = self.state();
        if state.answers.remove(&ticket.0).is_none()
            && state.open.get(&ticket.0).is_some_and(|open| matches!(open.role, Role::Once | Role::Makes))
        {
            state.forgotten.insert(ticket.0);
        }
    }
}
