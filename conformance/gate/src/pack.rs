//! A pack: the cases as files, for a renderer that answers by files.

pub use super::error::PackError;
use super::picture::within;
use super::plan::{CasePlace, GatePlan};
use super::{columns, frame};
use lightmeter_catalogue::cases::blend::Program;
use lightmeter_catalogue::cases::{GENERATOR_VERSION, Input, Kind, Output, Spec, ValueShape};
use lightmeter_catalogue::special::Probe;
use lightmeter_document::Unique;
use lightmeter_document::list::{ListedFormula, ListedValue};
use lightmeter_document::made_by::{LayerRequest, MadeBy};
use lightmeter_document::pack::{Choice, Listed, Manifest, PackedScene, SCHEMA};
use lightmeter_document::protocol::{CaseRequest, ProbeRequest};
use lightmeter_document::{Document as _, Number, Word};
use lightmeter_files::{Whole, read};
use lightmeter_judge::image::file::{StoredImage, whole};
use lightmeter_scene::blend::Separate;
use lightmeter_scene::frame::{Frame, Mesh, Texture};
use lightmeter_scene::target::TargetFormat;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::io::{BufWriter, Read as _, Write};
use std::path::Path;

const MANIFEST: &str = "manifest.json";
const CASES: &str = "cases.jsonl";
/// Random cases for each formula that a renderer is asked, at most.
pub const MOST_CASES: u64 = 10_000_000;
/// Pixels of a scene's longer side, at most.
const MOST_PIXELS: u32 = 8192;

/// A formula of a plan, with the number of its cases.
fn formula(plan: &GatePlan, formula: usize) -> ListedFormula {
    ListedFormula { count: Some(plan.formulas[formula].count()), ..described(&plan.member(formula).spec) }
}

/// A formula, what it takes and gives, and what computes it.
#[must_use]
pub fn described(spec: &Spec) -> ListedFormula {
    let value = |name: &'static str, shape: ValueShape, unit: &'static str, means: &'static str| ListedValue {
        name: name.into(),
        shape: shape.name().into(),
        unit: unit.into(),
        means: means.into(),
        domain: None,
    };
    let input = |input: &Input| value(input.name, input.shape, input.unit, spec.input_means(input));
    let output = |output: &Output| value(output.name, output.shape, output.unit, spec.output_means(output));
    ListedFormula {
        id: spec.id.clone(),
        formula: spec.text.into(),
        rules: spec.rules().into_iter().map(Word::from).collect(),
        source: None,
        made_by: made_by(spec),
        stages: vec![],
        stable: None,
        inputs: spec.inputs.iter().map(input).collect(),
        outputs: spec.outputs.iter().map(output).collect(),
        aliases: vec![],
        count: None,
    }
}

/// What computes a formula, or draws it: its function, how its matrices are laid out, its blend state or its depth test.
#[must_use]
pub fn made_by(spec: &Spec) -> MadeBy {
    let has_function = !spec.function.is_empty();
    let is_matrix = |shape: ValueShape| matches!(shape, ValueShape::Mat3 | ValueShape::Mat4);
    let has_matrices = spec.inputs.iter().any(|input| is_matrix(input.shape))
        || spec.outputs.iter().any(|output| is_matrix(output.shape));
    MadeBy {
        file: has_function.then(|| spec.file()),
        function: has_function.then(|| spec.function.to_owned()),
        matrices: has_matrices.then(|| "columns".into()),
        blend: if let Kind::Blend(program) = spec.kind { Some(layers(program)) } else { None },
        depth: if let Kind::Depth(test) = spec.kind { Some(test) } else { None },
        raster: if let Kind::Raster(raster) = spec.kind { Some(raster) } else { None },
    }
}

/// The states that a program draws by, one for each of its layers in turn.
fn layers(program: Program) -> Vec<LayerRequest> {
    let layers = if let Program::Layers(modes) = program { modes.len() } else { 1 };
    let layer = |number: usize| {
        let (Separate { color, alpha }, mask) = program.layer(number);
        let written: Vec<&str> =
            ["r", "g", "b", "a"].into_iter().zip(mask.0).filter(|(_, is)| *is).map(|(k, _)| k).collect();
        LayerRequest { color, alpha, mask: written.concat() }
    };
    (0..layers).map(layer).collect()
}

/// A case of a formula as a renderer is asked it.
#[must_use]
pub fn case(spec: &Spec, id: &str, row: &[f32]) -> CaseRequest {
    let mut inputs = Map::new();
    let mut rest = row;
    for input in spec.inputs {
        let (own, after) = rest.split_at(input.shape.components());
        rest = after;
        let numbers: Vec<Value> = own.iter().map(|&x| json!(Number(x.into()))).collect();
        let value = if let [one] = numbers.as_slice() { one.clone() } else { numbers.into() };
        inputs.insert(input.name.to_owned(), value);
    }
    CaseRequest { id: id.to_owned(), formula: spec.id.clone(), inputs, target: None, blend: None }
}

/// A case of a blend state as a renderer is asked it on a target: with the states that it draws by, one for each of its layers in turn.
#[must_use]
pub fn on_target(spec: &Spec, id: &str, row: &[f32], target: TargetFormat, program: Program) -> CaseRequest {
    CaseRequest { target: Some(target), blend: Some(layers(program)), ..case(spec, id, row) }
}

/// A probe of special values as a renderer is asked it: one operation on operands, which are told as numbers and bit for bit.
#[must_use]
pub fn probe(probe: &Probe) -> ProbeRequest {
    let named = |value: &dyn Fn(u32) -> Value| -> Map<String, Value> {
        let each = Probe::OPERANDS.iter().zip(probe.inputs);
        each.map(|(name, &bits)| ((*name).to_owned(), value(bits))).collect()
    };
    ProbeRequest {
        id: probe.id(),
        formula: probe.class.table().to_owned(),
        operation: probe.what.into(),
        function: probe.function().map(Word::from),
        inputs: named(&|bits| json!(Number(probe.operand(bits)))),
        inputs_hex: named(&|bits| format!("0x{bits:08x}").into()),
    }
}

/// Writes the pack of a plan into a folder, which is made, or must be empty or hold a pack, whose files go. The cases of formulas are
/// lines of JSON, or columns. `written` gets the name of each file once it is written; the manifest is the first and the last.
///
/// # Errors
/// Where a file cannot be written, or the folder holds something else.
pub fn write(
    plan: &GatePlan,
    folder: &Path,
    has_columns: bool,
    written: &mut dyn FnMut(&str),
) -> Result<Manifest, PackError> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |error: std::io::Error| PackError::Write { path, message: error.to_string() }
    };
    std::fs::create_dir_all(folder).map_err(failed(folder))?;
    clear(folder)?;
    // A pack that is broken off is known as one, with the files that it may have, and is written over.
    let path = folder.join(MANIFEST);
    let mut names = vec![CASES.to_owned()];
    if has_columns {
        names.extend((0..plan.formulas.len()).flat_map(|formula| columns::names(&plan.member(formula).spec)));
    }
    for scene in 0..plan.scenes.len() {
        names.extend(PackedDraw::new(plan, scene)?.files().map(|(name, _)| name));
    }
    let names: Vec<Value> = names.into_iter().map(|name| json!({ "name": name })).collect();
    let begun = json!({ "schema": SCHEMA, "is_unfinished": true, "files": names }).to_string();
    whole(&path, begun.as_bytes()).map_err(|error| PackError::Write { path, message: error.to_string() })?;
    written(MANIFEST);
    let mut files = vec![];
    let path = folder.join(CASES);
    let mut out = Summed::create(&path).map_err(failed(&path))?;
    write_cases(plan, has_columns, &mut out).map_err(failed(&path))?;
    files.push(out.finish(CASES).map_err(failed(&path))?);
    written(CASES);
    if has_columns {
        for formula in 0..plan.formulas.len() {
            files.extend(write_columns(plan, formula, folder)?);
        }
    }
    for scene in 0..plan.scenes.len() {
        for (name, bytes) in PackedDraw::new(plan, scene)?.files() {
            let path = folder.join(&name);
            let parent = path.parent().unwrap_or(folder);
            std::fs::create_dir_all(parent).map_err(failed(parent))?;
            whole(&path, &bytes).map_err(|error| PackError::Write { path, message: error.to_string() })?;
            written(&name);
            files.push(Listed { crc32: digits(&bytes), bytes: bytes.len() as u64, name });
        }
    }
    let manifest = Manifest { files, columns: has_columns, ..manifest(plan)? };
    let path = folder.join(MANIFEST);
    let text = manifest.to_json().map_err(|error| PackError::Plan(error.to_string()))?;
    whole(&path, text.as_bytes()).map_err(|error| PackError::Write { path, message: error.to_string() })?;
    written(MANIFEST);
    Ok(manifest)
}

/// Writes the inputs of a formula, a file each.
fn write_columns(plan: &GatePlan, formula: usize, folder: &Path) -> Result<Vec<Listed>, PackError> {
    let names: Vec<String> = columns::names(&plan.member(formula).spec).collect();
    let own = folder.join(columns::FOLDER).join(&plan.member(formula).spec.id);
    let failed = |error: std::io::Error| PackError::Write { path: own.clone(), message: error.to_string() };
    std::fs::create_dir_all(&own).map_err(failed)?;
    let create = |name: &String| Summed::create(&folder.join(name)).map_err(failed);
    let mut streams = names.iter().map(create).collect::<Result<Vec<_>, _>>()?;
    columns::write(plan, formula, &mut streams).map_err(failed)?;
    streams.into_iter().zip(&names).map(|(stream, name)| stream.finish(name).map_err(failed)).collect()
}

/// Writes the cases of formulas unless they are columns, behind them those of blend states on targets, and last special values, a line
/// each.
fn write_cases(plan: &GatePlan, has_columns: bool, out: &mut impl Write) -> std::io::Result<()> {
    let formulas = if has_columns { 0 } else { plan.formulas.len() };
    for formula in 0..formulas {
        let row = plan.rows(formula);
        for place in 0..plan.formulas[formula].count() {
            let id = plan.id(CasePlace::Case { formula, case: place });
            writeln!(out, "{}", case(&plan.member(formula).spec, &id, &row(place)))?;
        }
    }
    for state in 0..plan.states.len() {
        let spec = &plan.state_member(state).spec;
        let Kind::Blend(program) = spec.kind else { unreachable!("the plan has no other formulas on targets") };
        for &target in &plan.targets {
            for case in 0..plan.states[state].count() {
                let id = plan.id(CasePlace::Pixel { target, state, case });
                writeln!(out, "{}", on_target(spec, &id, &plan.state_inputs(state, case), target, program))?;
            }
        }
    }
    plan.probes.iter().try_for_each(|asked| writeln!(out, "{}", probe(asked)))
}

/// Takes the files of an earlier pack out of a folder, and nothing else.
fn clear(folder: &Path) -> Result<(), PackError> {
    let failed = |path: &Path, message: String| PackError::Write { path: path.into(), message };
    let mut entries = std::fs::read_dir(folder).map_err(|error| failed(folder, error.to_string()))?;
    if entries.next().is_none() {
        return Ok(());
    }
    let manifest = read::text(&folder.join(MANIFEST), read::MOST_TEXT).ok();
    let manifest: Option<Value> = manifest.and_then(|text| serde_json::from_str(&text).ok());
    let schema = manifest.as_ref().and_then(|manifest| manifest["schema"].as_str());
    let Some(manifest) = manifest.as_ref().filter(|_| schema.is_some_and(|name| name.starts_with("lightmeter.pack/")))
    else {
        let expected = "expected a new or an empty folder, or one with a pack";
        return Err(failed(folder, format!("it holds something else; {expected}")));
    };
    for file in manifest["files"].as_array().into_iter().flatten() {
        // What leads out of the folder is no file of the pack.
        if let Some(path) = file["name"].as_str().and_then(|name| within(folder, name).ok()) {
            match std::fs::remove_file(&path) {
                // One that was broken off has not all of its files.
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
                removed => removed.map_err(|error| failed(&path, error.to_string()))?,
            }
        }
    }
    Ok(())
}

/// The manifest of a plan, as yet without files.
fn manifest(plan: &GatePlan) -> Result<Manifest, PackError> {
    let scenes = (0..plan.scenes.len()).map(|scene| Ok(PackedDraw::new(plan, scene)?.listed()));
    Ok(Manifest {
        schema: SCHEMA.into(),
        generator: GENERATOR_VERSION,
        version: env!("CARGO_PKG_VERSION").into(),
        choice: plan.choice.clone(),
        pack: plan.pack().into(),
        columns: false,
        formulas: (0..plan.formulas.len()).map(|place| formula(plan, place)).collect(),
        probes: plan.probes.len(),
        on_targets: plan.targets.iter().map(|target| (target.name().to_owned(), plan.pixels())).collect(),
        scenes: scenes.collect::<Result<_, PackError>>()?,
        files: vec![],
    })
}

/// A scene of a pack.
struct PackedDraw {
    id: String,
    title: String,
    frame: Frame,
}

impl PackedDraw {
    fn new(plan: &GatePlan, scene: usize) -> Result<Self, PackError> {
        let (title, frame) = plan.frame(scene).map_err(|error| PackError::Plan(error.to_string()))?;
        Ok(Self { id: plan.id(CasePlace::Scene(scene)), title, frame })
    }

    fn folder(&self) -> String {
        self.id.replacen("scene/", "scenes/", 1)
    }

    /// As the manifest has it.
    fn listed(&self) -> PackedScene {
        let target = &self.frame.target;
        PackedScene {
            id: self.id.clone(),
            title: self.title.clone(),
            file: format!("{}/scene.json", self.folder()),
            width: target.width,
            height: target.height,
            format: target.format.name().into(),
        }
    }

    /// Its files, by their names.
    fn files(&self) -> impl Iterator<Item = (String, Vec<u8>)> {
        let (name, frame) = (self.folder(), &self.frame);
        let scene = frame::document(&self.id, &self.title, frame).to_json().expect("a frame has no map");
        let meshes = frame.meshes.iter().enumerate().map(|(k, mesh)| (format!("mesh-{k}.obj"), obj(mesh).into_bytes()));
        let textures = frame.textures.iter().enumerate().map(|(k, texture)| (format!("texture-{k}.png"), png(texture)));
        let scene = std::iter::once(("scene.json".to_owned(), scene.into_bytes()));
        scene.chain(meshes).chain(textures).map(move |(file, bytes)| (format!("{name}/{file}"), bytes))
    }
}

/// Counts and sums what is written.
struct Summed<W> {
    out: W,
    sum: crc32fast::Hasher,
    bytes: u64,
}

impl<W: Write> Write for Summed<W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.sum.update(&bytes[..written]);
        self.bytes += written as u64;
        Ok(written)
    }
    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

impl Summed<BufWriter<Whole>> {
    fn create(path: &Path) -> std::io::Result<Self> {
        Ok(Self { out: BufWriter::new(Whole::create(path)?), sum: crc32fast::Hasher::default(), bytes: 0 })
    }

    /// Puts the file in its place; how the manifest lists it.
    fn finish(self, name: &str) -> std::io::Result<Listed> {
        self.out.into_inner().map_err(std::io::IntoInnerError::into_error)?.finish()?;
        Ok(Listed { name: name.into(), bytes: self.bytes, crc32: format!("{:08x}", self.sum.finalize()) })
    }
}

fn digits(bytes: &[u8]) -> String {
    format!("{:08x}", crc32fast::hash(bytes))
}

/// A mesh as Wavefront OBJ, which has no colours and no second texture coordinates.
fn obj(mesh: &Mesh) -> String {
    let mut out = String::new();
    let mut line = |word: &str, numbers: &[f32]| {
        let numbers: Vec<String> = numbers.iter().map(f32::to_string).collect();
        let _ = writeln!(out, "{word} {}", numbers.join(" "));
    };
    mesh.positions.iter().for_each(|v| line("v", v));
    // Images have their first row at the top, OBJ's coordinates grow upward.
    mesh.uvs.iter().for_each(|[u, v]| line("vt", &[*u, 1.0 - v]));
    mesh.normals.iter().for_each(|v| line("vn", v));
    let corner = |k: u32| {
        let k = k + 1;
        match (mesh.uvs.is_empty(), mesh.normals.is_empty()) {
            (true, true) => k.to_string(),
            (true, false) => format!("{k}//{k}"),
            (false, true) => format!("{k}/{k}"),
            (false, false) => format!("{k}/{k}/{k}"),
        }
    };
    for triangle in &mesh.triangles {
        let corners = triangle.map(corner);
        let _ = writeln!(out, "f {}", corners.join(" "));
    }
    out
}

/// A texture as PNG of 8 bits.
fn png(texture: &Texture) -> Vec<u8> {
    let pixels = texture.texels.iter().map(|texel| texel.map(|c| f64::from(c) * 255.0)).collect();
    let image = StoredImage { width: texture.width as usize, format: TargetFormat::Rgba8Unorm, pixels };
    image.encode(Path::new("texture.png")).unwrap_or_default()
}

/// What the cases of a pack are chosen by.
const CHOOSE: &str = "`filter`, `cases`, `seed`, `size`, `targets` and `special`";

/// Reads the manifest of a pack, holds its files against it, and gives the cases that it is of.
///
/// # Errors
/// Where it is damaged, another version's, not what this lightmeter would write, or leads out of its folder.
pub fn read(folder: &Path) -> Result<GatePlan, PackError> {
    let path = folder.join(MANIFEST);
    let text = read::text(&path, read::MOST_TEXT).map_err(|error| PackError::Read {
        path: path.clone(),
        message: format!("{error}; `lightmeter pack DIR` writes a pack"),
    })?;
    let refused = |message: String| PackError::Manifest { path: path.clone(), message };
    let Unique(value) = serde_json::from_str(&text).map_err(|error| refused(format!("it is damaged: {error}")))?;
    match value.get("schema").and_then(Value::as_str) {
        Some(SCHEMA) => {}
        found => {
            let found = found.map_or_else(|| "nothing".into(), |found| format!("`{found}`"));
            return Err(refused(format!("its schema is {found}; expected `{SCHEMA}`")));
        }
    }
    if value.get("is_unfinished").is_some() {
        return Err(refused("it was not written to its end: write the pack again".into()));
    }
    let manifest: Manifest =
        serde_json::from_value(value).map_err(|error| refused(format!("it is damaged: {error}")))?;
    if manifest.generator != GENERATOR_VERSION {
        return Err(refused(format!(
            "its cases were drawn by generator {}; this lightmeter has {GENERATOR_VERSION}: write the pack again",
            manifest.generator
        )));
    }
    let Choice { cases, size, .. } = &manifest.choice;
    if !(1..=MOST_CASES).contains(cases) || size.is_some_and(|size| !(1..=MOST_PIXELS).contains(&size)) {
        return Err(refused(format!(
            "it has {cases} cases and scenes of {size:?} pixels; expected 1 to {MOST_CASES}, and to {MOST_PIXELS}"
        )));
    }
    for Listed { name, bytes, crc32 } in &manifest.files {
        let file = within(folder, name).map_err(|error| refused(format!("files: {error}")))?;
        let (found_bytes, found) =
            sum(&file).map_err(|error| PackError::Read { path: file.clone(), message: error.to_string() })?;
        if (found_bytes, found.as_str()) != (*bytes, crc32.as_str()) {
            let message = format!(
                "it is not what was packed: {found_bytes} bytes with checksum {found}; expected {bytes} with {crc32}"
            );
            return Err(PackError::Manifest { path: file, message });
        }
    }
    let plan = GatePlan::new(manifest.choice.clone()).map_err(|error| refused(error.to_string()))?;
    if let Some(what) = difference(&manifest, &plan)? {
        return Err(refused(format!("its {what} are not those that its {CHOOSE} choose: write the pack again")));
    }
    let own = plan.pack();
    if manifest.pack != own {
        return Err(refused(format!("its `pack` is not `{own}`, which its {CHOOSE} make it: write the pack again")));
    }
    Ok(plan)
}

/// What of a manifest is not as this lightmeter would write it for the plan. The cases themselves go by the generator's version.
fn difference(listed: &Manifest, plan: &GatePlan) -> Result<Option<&'static str>, PackError> {
    let own = manifest(plan)?;
    let asked = |manifest: &Manifest| -> Vec<ListedFormula> {
        manifest.formulas.iter().map(ListedFormula::without_explanations).collect()
    };
    if asked(listed) != asked(&own) {
        return Ok(Some("formulas"));
    }
    if listed.on_targets != own.on_targets {
        return Ok(Some("cases on targets"));
    }
    if listed.probes != own.probes {
        return Ok(Some("special values"));
    }
    if listed.scenes != own.scenes {
        return Ok(Some("scenes"));
    }
    let mut files: Vec<(String, Option<String>)> = vec![(CASES.into(), None)];
    if listed.columns {
        let names = (0..plan.formulas.len()).flat_map(|formula| columns::names(&plan.member(formula).spec));
        files.extend(names.map(|name| (name, None)));
    }
    for scene in 0..plan.scenes.len() {
        files.extend(PackedDraw::new(plan, scene)?.files().map(|(name, bytes)| (name, Some(digits(&bytes)))));
    }
    let is_same = |(file, (name, sum)): (&Listed, &(String, Option<String>))| {
        file.name == *name && sum.as_ref().is_none_or(|sum| *sum == file.crc32)
    };
    let are_same = files.len() == listed.files.len() && listed.files.iter().zip(&files).all(is_same);
    Ok((!are_same).then_some("files"))
}

fn sum(path: &Path) -> std::io::Result<(u64, String)> {
    let mut file = read::open(path)?;
    let (mut sum, mut all) = (crc32fast::Hasher::new(), 0);
    let mut part = vec![0; 1 << 16];
    loop {
        match file.read(&mut part)? {
            0 => return Ok((all, format!("{:08x}", sum.finalize()))),
            count => {
                sum.update(&part[..count]);
                all += count as u64;
            }
        }
    }
}
