//! A renderer in a process of its own, which speaks `lightmeter.protocol/1`: the formulas in f32, and scenes by the reference
//! renderer in f32. It shows what a renderer in Rust does, and can be told to fail in every way that a renderer may, for the
//! gate's own tests:
//!
//! ```text
//! lightmeter gate fog --exec 'target/debug/examples/renderer'
//! lightmeter gate fog --exec 'target/debug/examples/renderer crash-at=fog/exp/random/000017'
//! lightmeter gate blend --exec 'target/debug/examples/renderer targets=all blends-by=truncate'
//! ```

use lightmeter::blend_unit::embedded;
use lightmeter::blend_unit::rules::{FAULTS, Rules};
use lightmeter::cases::Kind;
use lightmeter::cases::blend::Program;
use lightmeter::document::Number;
use lightmeter::image::file::StoredImage;
use lightmeter::scene::load;
use lightmeter::select::{Member, alias_members, catalogue};
use lightmeter_reference::render::render;
use lightmeter_scene::target::TargetFormat;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io::{BufRead as _, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What goes wrong, and at which case.
struct Faults(HashMap<String, String>);

impl Faults {
    fn read() -> Self {
        let pair = |word: String| word.split_once('=').map(|(name, id)| (name.to_owned(), id.to_owned()));
        Self(std::env::args().skip(1).filter_map(pair).collect())
    }

    fn has(&self, fault: &str, id: &str) -> bool {
        let is_of = |at: &str| id.strip_prefix(at).is_some_and(|rest| rest.starts_with('/'));
        self.0.get(fault).is_some_and(|at| at == id || at == "all" || is_of(at))
    }
}

fn main() -> anyhow::Result<()> {
    let faults = Faults::read();
    let catalogue: Vec<Member> = catalogue().into_iter().chain(alias_members()).collect();
    let by_id = catalogue.iter().map(|member| (member.spec.id.as_str(), member)).collect();
    let mut renderer = Renderer { faults, by_id, folder: PathBuf::new(), answered: 0 };
    let mut out = std::io::BufWriter::with_capacity(1 << 20, std::io::stdout().lock());
    for line in std::io::stdin().lock().lines() {
        let request: Value = serde_json::from_str(&line?)?;
        if request.get("hello").is_some() {
            writeln!(out, "{}", renderer.hello(&request))?;
            out.flush()?;
        } else if request.get("batch").is_some() {
            out.flush()?;
        } else {
            renderer.respond(&request, &mut out)?;
        }
    }
    out.flush()?;
    if renderer.faults.has("lingers", "") {
        std::thread::sleep(Duration::from_secs(600));
    }
    if let Some(code) = renderer.faults.0.get("exit") {
        std::process::exit(code.parse()?);
    }
    Ok(())
}

/// What a renderer knows between requests.
struct Renderer<'a> {
    faults: Faults,
    by_id: HashMap<&'a str, &'a Member>,
    /// Where images are written.
    folder: PathBuf,
    answered: u32,
}

impl Renderer<'_> {
    fn hello(&mut self, request: &Value) -> Value {
        self.folder = request["folder"].as_str().unwrap_or_default().into();
        if self.faults.has("no-hello", "") {
            return json!("what?");
        }
        json!({
            "hello": "lightmeter.protocol/1",
            "renderer": "example",
            "version": "1.0",
            "formulas": ["**"],
            "scenes": ["**"],
            "targets": if self.faults.0.contains_key("targets") { TargetFormat::ALL.map(TargetFormat::name).to_vec() } else { vec![] },
        })
    }

    /// Answers a case, unless it is told to fail at it.
    fn respond(&mut self, request: &Value, out: &mut impl Write) -> anyhow::Result<()> {
        let id = request["id"].as_str().unwrap_or_default();
        self.faults.end(id, out)?;
        let mut answer = match request.get("scene") {
            Some(_) => draw(request, &self.folder, &self.faults)?,
            None => evaluate(request, &self.by_id, &self.faults),
        };
        self.answered += 1;
        if self.faults.has("unstable-at", id) {
            answer["value"][0] = json!(f64::from(self.answered));
        }
        self.faults.write_besides(id, &answer, out)?;
        self.faults.delay(id, out)?;
        if !self.faults.has("drop-at", id) {
            writeln!(out, "{answer}")?;
        }
        Ok(())
    }
}

impl Faults {
    /// Ends at a case without an answer: crashes, or hangs.
    fn end(&self, id: &str, out: &mut impl Write) -> anyhow::Result<()> {
        if self.has("crash-at", id) {
            // Like a renderer that loses what it had not written.
            std::process::abort();
        } else if self.has("hang-at", id) {
            out.flush()?;
            loop {
                std::thread::sleep(Duration::from_secs(1));
            }
        }
        Ok(())
    }

    /// Writes lines besides the answer that the protocol does not allow.
    fn write_besides(&self, id: &str, answer: &Value, out: &mut impl Write) -> anyhow::Result<()> {
        if self.has("long-at", id) {
            out.write_all(&vec![b'x'; 64 << 20])?;
            writeln!(out)?;
        }
        if self.has("truncated-at", id) {
            writeln!(out, "{{\"id\": \"{id}\", \"value\": [0.1, ")?;
        }
        if self.has("unknown-at", id) {
            writeln!(out, "{}", json!({ "id": "fog/none/random/000000", "value": [0] }))?;
        }
        if self.has("twice-at", id) {
            writeln!(out, "{answer}")?;
        }
        if self.has("hello-at", id) {
            writeln!(out, "{}", json!({ "hello": "lightmeter.protocol/1", "renderer": "another" }))?;
        }
        Ok(())
    }

    /// Takes its time over an answer: a little, or for ever with lines that answer nothing, without end or now and then.
    fn delay(&self, id: &str, out: &mut impl Write) -> anyhow::Result<()> {
        if self.0.get("slow-at").is_some_and(|formula| id.strip_prefix(formula.as_str()).is_some()) {
            std::thread::sleep(Duration::from_millis(10));
        }
        while self.has("flood-at", id) {
            writeln!(out, "{}", json!({ "id": "fog/none/random/000000", "value": [0] }))?;
        }
        while self.has("trickle-at", id) {
            writeln!(out)?;
            out.flush()?;
            std::thread::sleep(Duration::from_millis(50));
        }
        Ok(())
    }
}

/// A formula's outputs.
fn evaluate(request: &Value, by_id: &HashMap<&str, &Member>, faults: &Faults) -> Value {
    let id = &request["id"];
    let Some(member) = request["formula"].as_str().and_then(|formula| by_id.get(formula)) else {
        return json!({ "id": id, "skip": "no such formula" });
    };
    let mut row = vec![];
    for input in member.spec.inputs {
        let value = &request["inputs"][input.name];
        let numbers = value.as_array().map_or(std::slice::from_ref(value), Vec::as_slice);
        #[expect(clippy::cast_possible_truncation, reason = "inputs are f32")]
        row.extend(numbers.iter().map(|number| number.as_f64().unwrap_or(f64::NAN) as f32));
    }
    let target = request["target"].as_str().and_then(TargetFormat::by_name);
    let mut values = vec![0.0; member.spec.output_len()];
    match (target, member.spec.kind) {
        (Some(target), Kind::Blend(program)) => values = blended(program, target, &row, faults),
        _ => member.formula.embedded(&row, &mut values),
    }
    let name = id.as_str().unwrap_or_default();
    if faults.has("nan-at", name) {
        values[0] = f32::NAN;
    }
    if faults.has("wrong-at", name) {
        values[0] += 1.0;
    }
    if faults.has("short-at", name) {
        values.clear();
    }
    json!({ "id": id, "value": values.into_iter().map(|x| Number(x.into())).collect::<Vec<_>>() })
}

/// What a blend state leaves on a target.
fn blended(program: Program, target: TargetFormat, row: &[f32], faults: &Faults) -> Vec<f32> {
    let fault = faults.0.get("blends-by").and_then(|name| FAULTS.iter().find(|fault| fault.name == name));
    let rules = fault.map_or(Rules::RIGHT, |fault| fault.rules);
    #[expect(clippy::cast_possible_truncation, reason = "a pixel's numbers are steps, or those of a float format")]
    let narrow = |x: f64| x as f32;
    embedded::blend(program, target, &program.case(row), &rules).map(narrow).to_vec()
}

/// A scene's image. A renderer in another language would read the scene's file; this one knows it.
fn draw(request: &Value, folder: &Path, faults: &Faults) -> anyhow::Result<Value> {
    let id = request["id"].as_str().unwrap_or_default();
    let mut frame = load::scene(id)?.frame;
    let side = |name: &str| request[name].as_u64().and_then(|side| u32::try_from(side).ok());
    if let (Some(width), Some(height)) = (side("width"), side("height")) {
        (frame.target.width, frame.target.height) = (width, height);
    }
    if faults.has("half-at", id) {
        frame.target.width /= 2;
    }
    let name = format!("{}.exr", id.replace('/', "-"));
    if !faults.has("stale-at", id) {
        StoredImage::of(&render::<f32>(&frame, None, None), frame.target.format).write(&folder.join(&name))?;
    }
    let name = if faults.has("elsewhere-at", id) { "../elsewhere.exr".to_owned() } else { name };
    Ok(json!({ "id": id, "image": name }))
}
