//! Everything that reads what others wrote, each reader as a function of bytes: what `tests/fuzz` calls with bytes that it finds, and
//! `cargo test` with those of `tests/corpus`.
//!
//! A reader may accept its bytes or refuse them. It may not panic, hang, or say what a terminal or a CI system would take for a command.

use crate::place::folder;
use lightmeter::arithmetic::Accept;
use lightmeter::arithmetic::profile::PROFILES;
use lightmeter::document::bench::BenchDocument;
use lightmeter::document::eval::EvalRequest;
use lightmeter::document::event::Stop;
use lightmeter::document::pack::Choice;
use lightmeter::document::report::Report;
use lightmeter::document::{Document as _, special::SpecialReport};
use lightmeter::faults::Mistakes;
use lightmeter::files::{lines, shown};
use lightmeter::filter::Filter;
use lightmeter::gate::answer::{self, Line};
use lightmeter::gate::answers::{AnswerFile, FileRenderer};
use lightmeter::gate::baseline::Baseline;
use lightmeter::gate::expectations::Expectations;
use lightmeter::gate::hello;
use lightmeter::gate::pack;
use lightmeter::gate::picture;
use lightmeter::gate::plan::GatePlan;
use lightmeter::merge::merge;
use lightmeter::report::{self, Level, bench, github, junit, text};
use lightmeter::scene::library::asset;
use lightmeter::scene::load;
use lightmeter::select::{Member, catalogue};
use lightmeter::sweep::file;
use lightmeter_gpu::{Kernel, Shaders};
use lightmeter_scene::effects::effects;
use lightmeter_scene::frame::Frame;
use std::fmt::{Display, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, OnceLock};

/// What reads bytes of others.
#[derive(Clone, Copy)]
pub struct InputReader {
    /// Its name, and that of its folder in `tests/corpus`.
    pub name: &'static str,
    /// Reads bytes.
    pub read: fn(&[u8]),
    /// Bytes that are tried at most. What parses WGSL recurses, so that the command line gives it a process of its own.
    pub most: usize,
}

const fn reader(name: &'static str, read: fn(&[u8])) -> InputReader {
    InputReader { name, read, most: 1 << 16 }
}

const fn short(name: &'static str, read: fn(&[u8])) -> InputReader {
    InputReader { name, read, most: 1 << 12 }
}

/// All of them.
pub const READERS: &[InputReader] = &[
    reader("answers", answers),
    reader("baseline-gate", baseline_gate),
    reader("baseline-run", baseline_run),
    reader("bench", bench_page),
    reader("eval", eval),
    reader("expectations", expectations),
    short("filter", filter),
    short("formula", formula),
    reader("image-exr", |bytes| image("exr", bytes)),
    reader("image-npy", |bytes| image("npy", bytes)),
    reader("image-png", |bytes| image("png", bytes)),
    reader("merge-runs", runs),
    reader("merge-sweeps", sweeps),
    reader("mtl", |bytes| scene_with("house.mtl", bytes)),
    reader("obj", |bytes| scene_with("house.obj", bytes)),
    reader("pack", manifest),
    reader("protocol", protocol),
    reader("scene", scene),
    reader("special", special),
    reader("texture-png", |bytes| scene_with("bricks.png", bytes)),
    short("wgsl-effect", |bytes| wgsl("effects/spot.wgsl", bytes)),
    short("wgsl-function", |bytes| wgsl("fog.wgsl", bytes)),
];

/// The folder of what is read again and again: a folder for each reader.
#[must_use]
pub fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus")
}

/// Holds what is said to what terminals and CI systems may be shown: no escape, no line that begins a command.
fn said(words: impl Display) {
    let words = words.to_string();
    let shown = lines(&words);
    let is_plain = |c: char| c == '\n' || c == '\t' || !c.is_control();
    assert!(shown.chars().all(is_plain), "it says {shown:?}");
    assert!(!shown.lines().any(|line| line.trim_start().starts_with("::")), "it says {shown:?}");
    let one = self::shown(&words);
    assert!(!one.contains('\n') && one.chars().all(is_plain), "it says {one:?}");
}

/// Tells what was refused.
fn accepted<T, E: Display>(read: Result<T, E>) -> Option<T> {
    read.map_err(said).ok()
}

/// A folder of this process with one file, for what reads by path.
fn in_file<T>(name: &str, bytes: &[u8], read: impl FnOnce(&Path) -> T) -> T {
    static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| folder("readers"));
    let path = FOLDER.join(name);
    std::fs::write(&path, bytes).expect("a temporary file can be written");
    read(&path)
}

fn utf8(bytes: &[u8]) -> Option<&str> {
    std::str::from_utf8(bytes).ok()
}

fn plan() -> Arc<GatePlan> {
    static PLAN: OnceLock<Arc<GatePlan>> = OnceLock::new();
    let made = PLAN.get_or_init(|| {
        let choice = Choice {
            filter: vec!["fog/exp".into()],
            cases: 2,
            seed: 0,
            size: None,
            targets: vec![],
            held: vec![],
            special: false,
        };
        Arc::new(GatePlan::new(choice).expect("the choice is a valid one"))
    });
    Arc::clone(made)
}

fn answers(bytes: &[u8]) {
    in_file("answers.jsonl", bytes, |path| {
        let Some(file) = accepted(AnswerFile::open(path)) else { return };
        accepted(FileRenderer::read(plan(), vec![file], &Expectations::default(), Stop::default()));
    });
}

fn protocol(bytes: &[u8]) {
    for line in bytes.split(|&byte| byte == b'\n') {
        let _ = hello::is_one(line);
        if let Some(id) = answer::id(line) {
            said(id);
        }
        if let Some(Line::Hello(hello)) = accepted(answer::read(line)) {
            accepted(hello.filters());
            accepted(hello.profile(None));
        }
    }
}

fn baseline_gate(bytes: &[u8]) {
    in_file("baseline-gate.json", bytes, |path| accepted(Baseline::read(path, true)));
    result(bytes);
}

fn baseline_run(bytes: &[u8]) {
    in_file("baseline-run.json", bytes, |path| accepted(Baseline::read(path, false)));
}

/// A result in every form that is text.
fn result(bytes: &[u8]) -> Option<Report> {
    let report = utf8(bytes).and_then(|text| accepted(Report::read(text)))?;
    let style = text::Style { timing: true, level: Level::Verbose, ..text::Style::default() };
    let mut out = String::new();
    text::write(&report, style, &mut out).expect("a string takes all");
    said(out);
    junit::to_string(&report).expect("any report is XML");
    commands(&github::annotations(&report));
    Some(report)
}

/// Commands of a CI system are those that we mean.
fn commands(text: &str) {
    for line in text.lines().filter(|line| line.trim_start().starts_with("::")) {
        let is_ours =
            ["::error", "::warning", "::notice", "::group", "::endgroup"].iter().any(|own| line.starts_with(own));
        assert!(is_ours, "it says {line:?}");
    }
}

fn runs(bytes: &[u8]) {
    let Some(report) = result(bytes) else { return };
    accepted(merge(vec![("one".into(), report.clone()), ("two".into(), report)], &Mistakes));
}

fn sweeps(bytes: &[u8]) {
    let Some(document) = utf8(bytes).and_then(|text| accepted(file::parse(text))) else { return };
    let again = document.to_json().expect("a sweep is JSON");
    assert_eq!(file::parse(&again).expect("what was written is read").to_json().expect("it is JSON"), again);
    let mut out = String::new();
    report::sweep::write(&document, "a command", "", &mut out).expect("a string takes all");
    report::sweep::bars(&document, &mut out).expect("a string takes all");
    said(out);
    accepted(file::merge(&[("one".into(), document.clone()), ("two".into(), document)]));
}

fn bench_page(bytes: &[u8]) {
    let Some(document) = utf8(bytes).and_then(|text| accepted(BenchDocument::read(text))) else { return };
    let mut out = String::new();
    bench::page::readme(&document, &mut out).expect("a string takes all");
    said(out);
}

fn special(bytes: &[u8]) {
    let Some(document) = utf8(bytes).and_then(|text| accepted(SpecialReport::read(text))) else { return };
    let mut out = String::new();
    report::special::write(&document, &mut out).expect("a string takes all");
    said(out);
}

fn eval(bytes: &[u8]) {
    for line in bytes.split(|&byte| byte == b'\n').filter_map(utf8) {
        if let Some(request) = accepted(EvalRequest::read(line)) {
            said(request.formula);
        }
    }
}

fn expectations(bytes: &[u8]) {
    let Some(read) = in_file("expectations.toml", bytes, |path| accepted(Expectations::read(path))) else { return };
    let mut out = String::new();
    for id in read.ids() {
        let _ = writeln!(out, "{id}");
    }
    said(out);
}

fn formulas() -> &'static [Member] {
    static FORMULAS: OnceLock<Vec<Member>> = OnceLock::new();
    FORMULAS.get_or_init(catalogue)
}

fn filter(bytes: &[u8]) {
    let Some(text) = utf8(bytes) else { return };
    let globs: Vec<&str> = text.lines().collect();
    let Some(filter) = accepted(Filter::new(&globs)) else { return };
    for member in formulas().iter().step_by(31) {
        let id = &member.spec.id;
        // What is selected is reached from above.
        if !filter.is_empty() && filter.selects(id) {
            let family = id.split('/').next().unwrap_or_default();
            assert!(filter.selects(family) || filter.reaches_below(family), "{globs:?} and {id}");
        }
    }
}

/// A formula at any inputs, bits of f32: all that is made of them has ends, and they are in order.
fn formula(bytes: &[u8]) {
    let [a, b, rest @ ..] = bytes else { return };
    let member = &formulas()[usize::from(u16::from_le_bytes([*a, *b])) % formulas().len()];
    let mut words = rest.chunks_exact(4).map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    let count: usize = member.spec.inputs.iter().map(|input| input.shape.components()).sum();
    let inputs: Vec<f32> = (0..count).map(|_| words.next().unwrap_or_default()).collect();
    let (mut value, mut legal) = (vec![0.0; member.spec.output_len()], vec![Accept::ANY; member.spec.output_len()]);
    member.formula.reference(&inputs, &mut value);
    for profile in PROFILES {
        member.formula.promised_interval(member.spec.kind, &inputs, profile, &mut legal);
        for interval in &legal {
            assert!(interval.low() <= interval.high(), "{} {inputs:?} {}: {interval:?}", member.spec.id, profile.name);
        }
    }
}

/// A scene of a few pixels.
fn frame() -> &'static Frame {
    static FRAME: OnceLock<Frame> = OnceLock::new();
    FRAME.get_or_init(|| {
        let mut loaded = load::builtin("phong").expect("a built-in scene is valid");
        (loaded.frame.target.width, loaded.frame.target.height) = (4, 3);
        loaded.frame
    })
}

fn image(end: &str, bytes: &[u8]) {
    let name = format!("image.{end}");
    in_file(&name, bytes, |path| {
        let folder = path.parent().expect("it lies in a folder");
        if let Some(image) = accepted(picture::read(folder, &name, frame(), None)) {
            assert_eq!(image.pixels.len(), 12);
        }
    });
}

fn manifest(bytes: &[u8]) {
    in_file("manifest.json", bytes, |path| accepted(pack::read(path.parent().expect("it lies in a folder"))));
}

fn told(read: Result<load::Loaded, lightmeter::scene::SceneError>) {
    let Some(loaded) = accepted(read) else { return };
    let _ = effects(&loaded.frame);
    said(loaded.title);
}

fn scene(bytes: &[u8]) {
    if let Some(json) = utf8(bytes) {
        told(load::text("scene", json, &|name| asset(name)));
    }
}

/// The built-in scene of a house, of which one file is another.
fn scene_with(file: &str, bytes: &[u8]) {
    let json = include_str!("../../conformance/catalogue/scenes/obj.json");
    told(load::text("house", json, &|name| if name == file { Ok(bytes.to_vec()) } else { asset(name) }));
}

fn built_in() -> &'static Shaders {
    static SHADERS: OnceLock<Shaders> = OnceLock::new();
    SHADERS.get_or_init(|| Shaders::built_in().expect("the built-in shaders are valid"))
}

fn wgsl(file: &str, bytes: &[u8]) {
    let Some(text) = utf8(bytes) else { return };
    let Some(shaders) = accepted(built_in().with(file, text.into())) else { return };
    let family = file.trim_end_matches(".wgsl");
    let members: Vec<&Member> = formulas().iter().filter(|member| member.spec.family() == family).collect();
    // One is enough for a text, since each parses the whole; which one depends on the text.
    if let Some(member) = members.get(text.len() % members.len().max(1)) {
        accepted(Kernel::new(&shaders, file, member.spec.function));
    }
}
