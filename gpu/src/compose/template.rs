//! The skeleton with the effects' texts put into it.

use super::condition::{Condition, Named, Truth};
use super::{Intermediate, MOST_TOWARD, Technique};
use crate::error::GpuError;
use crate::shaders::{Shaders, effect_file};
use lightmeter_scene::effects::{Effect, Effects};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A line with where it is from.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) text: String,
    pub(super) file: Arc<str>,
    pub(super) number: usize,
}

impl Line {
    fn wrong(&self, message: &str) -> GpuError {
        let message = format!("{}:{}: {message}", self.file, self.number);
        GpuError::Shader { file: self.file.to_string(), message }
    }

    /// A line of this one's place.
    fn with(&self, text: String) -> Self {
        Self { text, file: self.file.clone(), number: self.number }
    }

    fn indent(&self) -> &str {
        &self.text[..self.text.len() - self.text.trim_start().len()]
    }
}

/// The lines of a file.
pub(super) fn lines(file: &str, text: &str) -> Vec<Line> {
    let file: Arc<str> = file.into();
    (1..).zip(text.lines()).map(|(number, text)| Line { text: text.into(), file: file.clone(), number }).collect()
}

/// The skeleton's files.
const SKELETON: [&str; 3] = ["scene.wgsl", "scene_lighting.wgsl", "scene_uniforms.wgsl"];

/// What is composed.
pub(super) struct Wanted {
    pub(super) effects: Effects,
    pub(super) stage: Option<Intermediate>,
    /// Whether the draw has normals, a stage without light included.
    pub(super) has_normals: bool,
    /// Whether every effect is there, behind switches.
    pub(super) full: bool,
    /// What is computed where; plain where the effects have no use for it.
    pub(super) technique: Technique,
    /// Lights whose vectors are interpolated.
    pub(super) toward: usize,
}

/// A part of the text.
#[derive(Debug)]
enum Node {
    Text(Line),
    When(Line, Condition, Vec<Self>),
    If(Line, Condition, Vec<Self>),
    Slot { line: Line, slot: String, members: bool },
    Choose { line: Line, name: String, ty: String, slot: String, otherwise: String },
}

/// A file, read.
#[derive(Debug, Default)]
struct File {
    /// What stands in no slot.
    items: Vec<Node>,
    slots: BTreeMap<String, Vec<Node>>,
}

/// The skeleton's files and the effects', read.
#[derive(Debug)]
pub(super) struct Template {
    named: Named,
    skeleton: Vec<File>,
    effects: Vec<(Effect, File)>,
}

/// A line that directs.
const MARK: &str = "//@ ";

impl Template {
    pub(super) fn new(shaders: &Shaders) -> Result<Self, GpuError> {
        let mut named = Named::new();
        let mut read = |file: &str| File::parse(lines(file, shaders.text(file)), &mut named);
        let skeleton = SKELETON.into_iter().map(&mut read).collect::<Result<Vec<_>, _>>()?;
        let effects = Effect::ALL
            .into_iter()
            .map(|effect| Ok((effect, read(&effect_file(effect))?)))
            .collect::<Result<Vec<_>, GpuError>>()?;
        let template = Self { named, skeleton, effects };
        template.check_slots()?;
        Ok(template)
    }

    /// Every slot that a file has text for is one that is asked for.
    fn check_slots(&self) -> Result<(), GpuError> {
        let files = || self.skeleton.iter().chain(self.effects.iter().map(|(_, file)| file));
        let mut asked = vec![];
        for file in files() {
            asked_slots(&file.items, &mut asked);
            file.slots.values().for_each(|nodes| asked_slots(nodes, &mut asked));
        }
        for (slot, nodes) in files().flat_map(|file| &file.slots) {
            if !asked.contains(slot) {
                let line = nodes.iter().find_map(Node::line);
                let place =
                    line.map_or(Line { text: String::new(), file: "scene.wgsl".into(), number: 1 }, Line::clone);
                return Err(
                    place.wrong(&format!("nothing asks for the slot `{slot}`; expected one of {}", asked.join(", ")))
                );
            }
        }
        Ok(())
    }

    /// The text of all that is wanted, reached or not.
    pub(super) fn expand(&self, wanted: &Wanted) -> Result<Vec<Line>, GpuError> {
        let mut out = vec![];
        let present = self.effects.iter().filter(|(effect, _)| wanted.full || wanted.effects.has(*effect));
        for file in self.skeleton.iter().chain(present.map(|(_, file)| file)) {
            self.nodes(&file.items, wanted, &mut out)?;
            out.push(Line { text: String::new(), file: "".into(), number: 0 });
        }
        Ok(out)
    }

    fn nodes(&self, nodes: &[Node], wanted: &Wanted, out: &mut Vec<Line>) -> Result<(), GpuError> {
        for node in nodes {
            match node {
                Node::Text(line) => out.push(line.clone()),
                Node::When(line, condition, inner) => {
                    let every = |name: &str| {
                        wanted.truth(name).map(|truth| match truth {
                            Truth::Switched(_) => Truth::Known(true),
                            known => known,
                        })
                    };
                    let truth = condition.truth(&self.named, &every).map_err(|message| line.wrong(&message))?;
                    if truth == Truth::Known(true) {
                        self.nodes(inner, wanted, out)?;
                    }
                }
                Node::If(line, condition, inner) => {
                    let truth = condition.truth(&self.named, &|name| wanted.truth(name));
                    match truth.map_err(|message| line.wrong(&message))? {
                        Truth::Known(false) => {}
                        Truth::Known(true) => self.nodes(inner, wanted, out)?,
                        Truth::Switched(text) => {
                            out.push(line.with(format!("{}if {text} {{", line.indent())));
                            self.nodes(inner, wanted, out)?;
                            out.push(line.with(format!("{}}}", line.indent())));
                        }
                    }
                }
                Node::Slot { line, slot, members } => self.slot(line, slot, *members, wanted, out)?,
                Node::Choose { line, name, ty, slot, otherwise } => {
                    let found = self.choices(slot, wanted)?;
                    choose(line, [name, ty, otherwise], found, wanted, out)?;
                }
            }
        }
        Ok(())
    }

    fn slot(
        &self,
        line: &Line,
        slot: &str,
        members: bool,
        wanted: &Wanted,
        out: &mut Vec<Line>,
    ) -> Result<(), GpuError> {
        let mut put = |text: Vec<Line>, switch: Option<String>| {
            let indent = line.indent();
            out.extend(switch.iter().map(|switch| line.with(format!("{indent}if {switch} {{"))));
            out.extend(text.into_iter().map(|text| indented(&text, indent)));
            out.extend(switch.iter().map(|_| line.with(format!("{indent}}}"))));
        };
        for nodes in self.skeleton.iter().filter_map(|file| file.slots.get(slot)) {
            let mut text = vec![];
            self.nodes(nodes, wanted, &mut text)?;
            put(text, None);
        }
        for (effect, text) in self.choices(slot, wanted)? {
            put(text, (wanted.full && !members).then(|| switch(effect)));
        }
        Ok(())
    }

    /// The wanted effects' texts for a slot.
    fn choices(&self, slot: &str, wanted: &Wanted) -> Result<Vec<(Effect, Vec<Line>)>, GpuError> {
        let mut found = vec![];
        for (effect, file) in &self.effects {
            if let Some(nodes) = file.slots.get(slot).filter(|_| wanted.full || wanted.effects.has(*effect)) {
                let mut text = vec![];
                self.nodes(nodes, wanted, &mut text)?;
                found.push((*effect, text));
            }
        }
        Ok(found)
    }
}

impl Wanted {
    fn truth(&self, name: &str) -> Option<Truth> {
        if name == "has_normals" {
            return Some(Truth::Known(self.has_normals));
        }
        match name {
            "fog_at_vertex" => return Some(Truth::Known(self.technique == Technique::FogAtVertex)),
            "vectors_interpolated" => return Some(Truth::Known(self.technique.has_vectors())),
            "unit_vectors" => return Some(Truth::Known(self.technique == Technique::UnitVectorsInterpolated)),
            _ => {}
        }
        if let Some(number) = name.strip_prefix("toward_") {
            let number: usize = number.parse().ok().filter(|number| (1..=MOST_TOWARD).contains(number))?;
            return Some(Truth::Known(self.toward >= number));
        }
        if let Some(stage) = name.strip_prefix("stage_") {
            let stage = Intermediate::ALL.into_iter().find(|of| of.name() == stage)?;
            return Some(Truth::Known(self.stage == Some(stage)));
        }
        let effect = Effect::ALL.into_iter().find(|effect| effect.name() == name)?;
        Some(if self.full { Truth::Switched(switch(effect)) } else { Truth::Known(self.effects.has(effect)) })
    }
}

/// Whether an effect is switched on.
fn switch(effect: Effect) -> String {
    let bit = effect as u32;
    let component = if bit < 32 { 'x' } else { 'y' };
    format!("(scene_switches.bits.{component} & {:#x}u) != 0u", 1_u32 << (bit % 32))
}

fn indented(line: &Line, indent: &str) -> Line {
    let text = if line.text.is_empty() { String::new() } else { format!("{indent}{}", line.text) };
    line.with(text)
}

/// A value by one of the expressions that were found: by the only one, or by the switches.
fn choose(
    line: &Line,
    [name, ty, otherwise]: [&str; 3],
    found: Vec<(Effect, Vec<Line>)>,
    wanted: &Wanted,
    out: &mut Vec<Line>,
) -> Result<(), GpuError> {
    let indent = line.indent();
    let give = |head: &str, indent: &str, mut text: Vec<Line>| {
        if let Some(first) = text.first_mut() {
            first.text = format!("{head}{}", first.text);
        }
        if let Some(last) = text.last_mut() {
            last.text.push(';');
        }
        text.iter().map(|line| indented(line, indent)).collect::<Vec<_>>()
    };
    let otherwise = vec![line.with(otherwise.to_owned())];
    if !wanted.full {
        let mut found = found.into_iter();
        let text = found.next().map_or(otherwise, |(_, text)| text);
        if let Some((effect, _)) = found.next() {
            return Err(line.wrong(&format!("two effects give `{name}`, one of them {}", effect.name())));
        }
        out.extend(give(&format!("let {name} = "), indent, text));
        return Ok(());
    }
    out.push(line.with(format!("{indent}var {name}: {ty};")));
    let inner = format!("{indent}    ");
    let mut before = indent.to_owned();
    for (effect, text) in found {
        out.push(line.with(format!("{before}if {} {{", switch(effect))));
        out.extend(give(&format!("{name} = "), &inner, text));
        before = format!("{indent}}} else ");
    }
    out.push(line.with(format!("{before}{{")));
    out.extend(give(&format!("{name} = "), &inner, otherwise));
    out.push(line.with(format!("{indent}}}")));
    Ok(())
}

impl Node {
    const fn line(&self) -> Option<&Line> {
        match self {
            Self::Text(line)
            | Self::When(line, ..)
            | Self::If(line, ..)
            | Self::Slot { line, .. }
            | Self::Choose { line, .. } => Some(line),
        }
    }
}

fn asked_slots(nodes: &[Node], asked: &mut Vec<String>) {
    for node in nodes {
        match node {
            Node::Text(_) => {}
            Node::When(_, _, inner) | Node::If(_, _, inner) => asked_slots(inner, asked),
            Node::Slot { slot, .. } | Node::Choose { slot, .. } => asked.push(slot.clone()),
        }
    }
}

impl File {
    fn parse(lines: Vec<Line>, named: &mut Named) -> Result<Self, GpuError> {
        let mut file = Self::default();
        let mut at: Option<String> = None;
        // The blocks that are open, the innermost last: the line that opened each, and what is in it so far.
        let mut blocks: Vec<(Line, bool, Condition, Vec<Node>)> = vec![];
        for line in lines {
            let Some(directive) = line.text.trim_start().strip_prefix(MARK).map(str::to_owned) else {
                // Blank lines and comments of an effect's slot are left out.
                let is_text = !line.text.trim().is_empty();
                if is_text || at.is_none() {
                    file.put(at.as_deref(), &mut blocks, Node::Text(line));
                }
                continue;
            };
            let (verb, rest) = directive.split_once(' ').unwrap_or((&directive, ""));
            let condition = |text: &str| Condition::parse(text).map_err(|message| line.wrong(&message));
            let node = match verb {
                "let" => {
                    let (name, text) =
                        rest.split_once('=').ok_or_else(|| line.wrong("expected `let name = condition`"))?;
                    named.insert(name.trim().into(), condition(text)?);
                    continue;
                }
                "at" => {
                    at = Some(rest.trim().into());
                    file.slots.entry(rest.trim().into()).or_default();
                    continue;
                }
                "when" | "if" => {
                    blocks.push((line.clone(), verb == "if", condition(rest)?, vec![]));
                    continue;
                }
                "end" => {
                    let (line, is_if, condition, inner) =
                        blocks.pop().ok_or_else(|| line.wrong("nothing is open that this could end"))?;
                    if is_if { Node::If(line, condition, inner) } else { Node::When(line, condition, inner) }
                }
                "slot" | "members" => {
                    Node::Slot { slot: rest.trim().into(), members: verb == "members", line: line.clone() }
                }
                "choose" => {
                    let parts = rest.split_once(" else ").and_then(|(head, otherwise)| {
                        let (head, slot) = head.split_once(" from ")?;
                        let (name, ty) = head.split_once(": ")?;
                        Some([name, ty, slot, otherwise].map(str::to_owned))
                    });
                    let [name, ty, slot, otherwise] =
                        parts.ok_or_else(|| line.wrong("expected `choose name: type from slot else expression`"))?;
                    Node::Choose { line: line.clone(), name, ty, slot, otherwise }
                }
                _ => return Err(line.wrong(&format!("`{verb}` is no directive"))),
            };
            file.put(at.as_deref(), &mut blocks, node);
        }
        match blocks.pop() {
            None => Ok(file),
            Some((line, ..)) => Err(line.wrong("no `//@ end` ends this")),
        }
    }

    fn put(&mut self, at: Option<&str>, blocks: &mut [(Line, bool, Condition, Vec<Node>)], node: Node) {
        let nodes = match (blocks.last_mut(), at) {
            (Some((.., inner)), _) => inner,
            (None, Some(slot)) => self.slots.entry(slot.into()).or_default(),
            (None, None) => &mut self.items,
        };
        nodes.push(node);
    }
}
