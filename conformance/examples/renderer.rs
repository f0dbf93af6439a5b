//! A renderer in a process of its own, which speaks `lightmeter.protocol/1`: the formulas in f32, and scenes by the reference
//! renderer in f32. It shows what a renderer in Rust does, and can be told to fail in every way that a renderer may, for the
//! gate's own tests:
//!
//! ```text
//! lightmeter gate fog --exec 'target/debug/examples/renderer'
//! lightmeter gate fog --exec 'target/debug/examples/renderer crash-at=fog/exp/random/000017'
//! lightmeter gate blend --exec 'target/debug/examples/renderer targets=all blends-by=truncate'
//! lightmeter gate special --exec 'target/debug/examples/renderer special=true'
//! lightmeter gate special --exec 'target/debug/examples/renderer special=swaps-select'
//! lightmeter gate fog --exec 'target/debug/examples/renderer columns=f4'
//! lightmeter gate fog --exec 'target/debug/examples/renderer describe=all'
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
use std::collections::{HashMap, HashSet};
use std::io::{BufRead as _, Read as _, Write};
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
    let mut renderer = Renderer {
        faults,
        by_id,
        folder: PathBuf::new(),
        answered: 0,
        withholds: false,
        slow: Default::default(),
        described: HashSet::new(),
    };
    let mut out = std::io::BufWriter::with_capacity(1 << 20, std::io::stdout().lock());
    let (mut stream, mut line) = (std::io::stdin().lock(), vec![]);
    while stream.read_until(b'\n', &mut line)? > 0 {
        let request: Value = serde_json::from_slice(&line)?;
        line.clear();
        if let Some(described) = request.get("describe") {
            renderer.described.insert(described["id"].as_str().unwrap_or_default().to_owned());
            continue;
        }
        renderer.knows(&request)?;
        if let Some(count) = request["bytes"].as_u64() {
            let mut bytes = vec![0; usize::try_from(count)?];
            stream.read_exact(&mut bytes)?;
            renderer.respond_in_columns(&request, &bytes, &mut out)?;
            out.flush()?;
            if matches!(renderer.faults.0.get("columns").map(String::as_str), Some("few" | "unended")) {
                stall(&mut out)?;
            }
        } else if request.get("hello").is_some() {
            writeln!(out, "{}", renderer.hello(&request))?;
            out.flush()?;
        } else if request.get("batch").is_some() {
            let (time, answers) = std::mem::take(&mut renderer.slow);
            passes(time, &mut out)?;
            out.write_all(&answers)?;
            out.flush()?;
            if std::mem::take(&mut renderer.withholds) {
                stall(&mut out)?;
            }
        } else if renderer.faults.0.contains_key("slow-at") {
            let (time, mut answers) = std::mem::take(&mut renderer.slow);
            renderer.respond(&request, &mut answers)?;
            let id = request["id"].as_str().unwrap_or_default();
            let is_slow = renderer.faults.0["slow-at"].as_str();
            renderer.slow = (time + Duration::from_millis(if id.starts_with(is_slow) { 10 } else { 0 }), answers);
        } else {
            renderer.respond(&request, &mut out)?;
        }
    }
    out.flush()?;
    if renderer.faults.has("lingers", "") {
        hang(&mut out)?;
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
    /// Whether it did not write all of an answer.
    withholds: bool,
    /// How long its answers to a batch take together, and these answers.
    slow: (Duration, Vec<u8>),
    /// The formulas that were described.
    described: HashSet<String>,
}

impl Renderer<'_> {
    /// That a formula was described before it is asked for, where descriptions are.
    fn knows(&self, request: &Value) -> anyhow::Result<()> {
        let formula = request.get("formula").or_else(|| request.get("columns")).and_then(Value::as_str);
        let is_described = formula.is_none_or(|formula| self.described.contains(formula));
        anyhow::ensure!(is_described || !self.faults.0.contains_key("describe"), "{formula:?} was not described");
        Ok(())
    }

    fn hello(&mut self, request: &Value) -> Value {
        self.folder = request["folder"].as_str().unwrap_or_default().into();
        if self.faults.has("no-hello", "") {
            return json!("what?");
        }
        let mut hello = json!({
            "hello": "lightmeter.protocol/1",
            "renderer": "example",
            "version": "1.0",
            "formulas": [self.faults.0.get("formulas").map_or("**", String::as_str)],
            "scenes": ["**"],
            "skips": [{ "id": "special", "reason": "no rasteriser, no numbers of 16 bits and no packing" }],
            "columns": self.faults.0.contains_key("columns"),
            "describe": self.faults.0.contains_key("describe"),
            "special": self.faults.0.contains_key("special"),
            "targets": if self.faults.0.contains_key("targets") { TargetFormat::ALL.map(TargetFormat::name).to_vec() } else { vec![] },
        });
        if let Some(build) = self.faults.0.get("build") {
            hello["build"] = json!(build);
        }
        hello
    }

    /// Answers a batch in columns by numbers of the type that it is told, `f4` or `f8`, or fails as it is told.
    fn respond_in_columns(&self, request: &Value, bytes: &[u8], out: &mut impl Write) -> anyhow::Result<()> {
        let mut head = json!({ "columns": request["columns"], "batch": request["batch"] });
        let way = self.faults.0.get("columns").map_or("f4", String::as_str);
        match way {
            "crash" => std::process::abort(),
            "hang" => hang(out)?,
            "skips" => head["skip"] = json!("not built"),
            "errors" => head["error"] = json!("no memory"),
            "lines" => head["lines"] = json!(true),
            "nothing" => {}
            "cases" => head = json!({ "id": "fog/exp/random/000000", "value": [0.5] }),
            "other" => head["batch"] = json!(0),
            _ => {}
        }
        if !matches!(
            way,
            "f4" | "f8"
                | "short"
                | "other"
                | "type"
                | "wrong"
                | "surplus"
                | "few"
                | "huge"
                | "both"
                | "joined"
                | "unended"
        ) {
            writeln!(out, "{head}")?;
            return Ok(());
        }
        let mut data = self.arrays(request, bytes, way)?;
        if way == "short" {
            data.truncate(data.len() - 4);
        }
        head["bytes"] = json!(if way == "huge" { 1_000_000_000_000_000 } else { data.len() });
        match way {
            // More and fewer bytes than the line announces.
            "surplus" => data.extend([0x7f; 5]),
            "few" => data.truncate(data.len() - 8),
            "both" => head["lines"] = json!(true),
            // No byte of it is a newline.
            "unended" => data.fill(0),
            _ => {}
        }
        head["dtype"] = json!(match way {
            "f8" => "<f8",
            "type" => "<i4",
            _ => "<f4",
        });
        write!(out, "{head}{}", if matches!(way, "joined" | "unended") { "" } else { "\n" })?;
        out.write_all(&data)?;
        Ok(())
    }

    /// The outputs of a batch in columns, an array for each.
    fn arrays(&self, request: &Value, bytes: &[u8], way: &str) -> anyhow::Result<Vec<u8>> {
        let member = self.by_id[request["columns"].as_str().unwrap_or_default()];
        let numbers: Vec<f32> =
            bytes.chunks_exact(4).map(|part| part.try_into().map(f32::from_le_bytes)).collect::<Result<_, _>>()?;
        let count = usize::try_from(request["count"].as_u64().unwrap_or_default())?;
        let outputs: Vec<Vec<f32>> = (0..count)
            .map(|row| {
                let (mut inputs, mut start) = (vec![], 0);
                for input in member.spec.inputs {
                    let components = input.shape.components();
                    inputs.extend_from_slice(&numbers[start + row * components..start + (row + 1) * components]);
                    start += count * components;
                }
                let mut values = vec![0.0; member.spec.output_len()];
                member.formula.embedded(&inputs, &mut values);
                values
            })
            .collect();
        let (mut data, mut start) = (vec![], 0);
        for output in member.spec.outputs {
            let components = output.shape.components();
            for value in outputs.iter().flat_map(|row| &row[start..start + components]) {
                let value = if way == "wrong" { value + 1.0 } else { *value };
                if way == "f8" {
                    data.extend(f64::from(value).to_le_bytes());
                } else {
                    data.extend(value.to_le_bytes());
                }
            }
            start += components;
        }
        Ok(data)
    }

    /// Answers a case, unless it is told to fail at it.
    fn respond(&mut self, request: &Value, out: &mut impl Write) -> anyhow::Result<()> {
        let id = request["id"].as_str().unwrap_or_default();
        self.faults.end(id, out)?;
        let mut answer = if request.get("scene").is_some() {
            draw(request, &self.folder, &self.faults)?
        } else if request.get("function").is_some() {
            special(request, &self.faults)
        } else {
            evaluate(request, &self.by_id, &self.faults)
        };
        self.answered += 1;
        if self.faults.has("unstable-at", id) {
            answer["value"][0] = json!(f64::from(self.answered));
        }
        self.faults.write_besides(id, &answer, out)?;
        self.faults.delay(id, out)?;
        self.withholds |= self.faults.has("unended-at", id) || self.faults.has("drop-at", id);
        if self.faults.has("unended-at", id) {
            write!(out, "{answer}")?;
        } else if !self.faults.has("drop-at", id) {
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
            // A test waits for this file.
            self.0.get("tells").map(|file| std::fs::write(file, "it hangs")).transpose()?;
            hang(out)?;
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

    /// Takes its time over an answer: for ever with lines that answer nothing, without end or now and then.
    fn delay(&self, id: &str, out: &mut impl Write) -> anyhow::Result<()> {
        while self.has("flood-at", id) {
            writeln!(out, "{}", json!({ "id": "fog/none/random/000000", "value": [0] }))?;
        }
        while self.has("trickle-at", id) {
            writeln!(out)?;
            passes(Duration::from_millis(50), out)?;
            out.flush()?;
        }
        Ok(())
    }
}

/// Longer than anything may take.
const LONG: Duration = Duration::from_secs(600);

/// Lets time pass: by the test's clock, which a mark in the output moves, or really.
fn passes(time: Duration, out: &mut impl Write) -> anyhow::Result<()> {
    if std::env::var_os("LIGHTMETER_CLOCK").is_some() {
        out.write_all(b"\xffpasses:")?;
        write!(out, "{:08}", time.as_millis())?;
    } else if time < LONG {
        std::thread::sleep(time);
    }
    Ok(())
}

/// Lets more time pass than anything may take.
fn stall(out: &mut impl Write) -> anyhow::Result<()> {
    passes(LONG, out)?;
    Ok(out.flush()?)
}

/// Does nothing any more.
fn hang(out: &mut impl Write) -> anyhow::Result<()> {
    stall(out)?;
    loop {
        std::thread::sleep(LONG);
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

/// What an operation on special values comes to.
fn special(request: &Value, faults: &Faults) -> Value {
    let id = &request["id"];
    let operand = |name: &str| {
        let digits = request["inputs_hex"][name].as_str().and_then(|digits| digits.strip_prefix("0x"));
        digits.and_then(|digits| u32::from_str_radix(digits, 16).ok()).unwrap_or_default()
    };
    let operands = ["x", "y", "z"].map(operand);
    let function = request["function"].as_str().unwrap_or_default();
    let swaps_select = faults.0.get("special").is_some_and(|fault| fault == "swaps-select");
    let name = id.as_str().unwrap_or_default();
    if faults.has("short-at", name) {
        return json!({ "id": id, "value": [] });
    }
    match (float(function, operands, swaps_select), word(function, operands)) {
        (Some(_), _) if faults.has("nan-at", name) => json!({ "id": id, "hex": "0xffc00001" }),
        // A number in JSON has no payload.
        (Some(x), _) if x.is_nan() => json!({ "id": id, "hex": format!("0x{:08x}", x.to_bits()) }),
        (Some(x), _) => json!({ "id": id, "value": [Number(x.into())] }),
        (None, Some(word)) => json!({ "id": id, "value": [word] }),
        (None, None) => json!({ "id": id, "skip": "no numbers of 16 bits and no packing" }),
    }
}

/// The functions that give a float; `None` of another one.
fn float(function: &str, operands: [u32; 3], swaps_select: bool) -> Option<f32> {
    let [x, y, z] = operands.map(f32::from_bits);
    let dot = x * x + y * y + z * z;
    let between = |x: f32, low: f32, high: f32| x.max(low).min(high);
    #[expect(clippy::cast_precision_loss, reason = "the conversion is what is asked for")]
    let from_word = operands[0] as f32;
    Some(match function {
        "special_keep" => x,
        "special_add" => x + y,
        "special_subtract" => x - y,
        "special_multiply" => x * y,
        "special_divide" => x / y,
        "special_negate" => -x,
        "special_fma" => x.mul_add(y, z),
        "special_multiply_add" => x * y + z,
        "special_min" => x.min(y),
        "special_max" => x.max(y),
        "special_clamp" => between(x, y, z),
        "special_saturate" => between(x, 0.0, 1.0),
        "special_select" if (z > 0.5) != swaps_select => y,
        "special_select" => x,
        "special_abs" => x.abs(),
        "special_sign" if x == 0.0 => x,
        "special_sign" => x.signum(),
        "special_floor" => x.floor(),
        "special_ceil" => x.ceil(),
        "special_fract" => x - x.floor(),
        "special_round" => x.round_ties_even(),
        "special_trunc" => x.trunc(),
        "special_mix" => x * (1.0 - z) + y * z,
        "special_step" => f32::from(u8::from(x <= y)),
        "special_smoothstep" => {
            let t = between((z - x) / (y - x), 0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        }
        "special_sqrt" => x.sqrt(),
        "special_inverse_sqrt" => 1.0 / x.sqrt(),
        "special_exp" => x.exp(),
        "special_exp2" => x.exp2(),
        "special_log" => x.ln(),
        "special_pow" => x.powf(y),
        "special_normalize" => x / dot.sqrt(),
        "special_length" => dot.sqrt(),
        "special_dot" => dot,
        "special_from_u32" => from_word,
        _ => return None,
    })
}

/// The functions that give a word, and comparisons; `None` of another one.
fn word(function: &str, operands: [u32; 3]) -> Option<u32> {
    let [x, y, _] = operands.map(f32::from_bits);
    let holds = match function {
        #[expect(clippy::float_cmp, reason = "the comparison is what is asked for")]
        "special_equal" => x == y,
        "special_equals_itself" => !x.is_nan(),
        "special_differs_from_itself" => x.is_nan(),
        "special_less" => x < y,
        "special_not_less" => x >= y || x.is_nan() || y.is_nan(),
        "special_is_nan_by_bits" => operands[0] & 0x7fff_ffff > 0x7f80_0000,
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the conversion is what is asked for"
        )]
        "special_to_u32" => return Some(x as u32),
        #[expect(clippy::cast_possible_truncation, reason = "the conversion is what is asked for")]
        "special_to_i32" => return Some((x as i32).cast_unsigned()),
        _ => return None,
    };
    Some(u32::from(holds))
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
