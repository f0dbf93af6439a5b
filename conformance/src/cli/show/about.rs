//! What is known of a name that is no case: of a formula, a family, a scene, a deviation, a mistake, a ruling or a source.

use crate::cli::list::with_unit;
use crate::cli::mistakes::{all_names, document as mistakes};
use anyhow::bail;
use lightmeter::cases::blend::{COMMON, aliases, written_state};
use lightmeter::cases::{DRAWN, Kind, Spec, boundary_names};
use lightmeter::dialects::DIALECTS;
use lightmeter::faults::{Fault, concerning};
use lightmeter::filter::Filter;
use lightmeter::nearest::did_you_mean;
use lightmeter::report;
use lightmeter::report::table::{Align, TextTable};
use lightmeter::rulings::{GLOSSARY, RULINGS, Ruling, SOURCES};
use lightmeter::scene::library::SCENES;
use lightmeter::scene::load::{self, Loaded};
use lightmeter::select::Member;
use lightmeter::special::{PROBES, Probe};
use lightmeter::witness::NamedDeviation;
use lightmeter_gpu::Shaders;
use lightmeter_gpu::compose::{Composer, Recipe, ShaderForm};
use lightmeter_scene::effects::effects;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// What there is to say of a name; `None` where it may be a case.
pub(super) fn about(name: &str, catalogue: &[Member]) -> anyhow::Result<Option<String>> {
    if name.trim().is_empty() {
        bail!("an empty name shows nothing; expected such as `fog/exp`, `scene/phong` or `ruling/9`");
    }
    let written = written_state(name).transpose().map_err(anyhow::Error::msg)?;
    let name = written.as_deref().unwrap_or(name);
    let spelt = ruling_of(name);
    let name = spelt.as_deref().unwrap_or(name);
    if name == "rulings" {
        let lines = RULINGS.iter().map(|ruling| format!("ruling/{:<3} {}\n", ruling.number, ruling.title));
        return Ok(Some(lines.collect()));
    }
    if name == "glossary" {
        return Ok(Some(GLOSSARY.iter().map(|(words, means)| format!("{words}: {means}\n")).collect()));
    }
    let id = canonical(name);
    if let Some(member) = catalogue.iter().find(|member| member.spec.id == id) {
        return formula(name, member).map(Some);
    }
    if let Some(scene) = name.strip_prefix("scene/").filter(|scene| !scene.contains('/')) {
        if SCENES.iter().any(|(own, _)| *own == scene) {
            return of_scene(&load::builtin(scene)?).map(Some);
        }
        bail!("no scene `{scene}`{}", did_you_mean(scene, SCENES.iter().map(|(own, _)| *own)));
    }
    if let Some(number) = name.strip_prefix("ruling/") {
        let found = RULINGS.iter().find(|ruling| ruling.number.to_string() == number);
        let Some(ruling) = found else { bail!("no ruling {number}; there are 1 to {}", RULINGS.len()) };
        return Ok(Some(of_ruling(ruling)?));
    }
    if let Some(source) = SOURCES.iter().find(|source| source.name == name) {
        return Ok(Some(format!("document {}: {}\n", source.name, source.what)));
    }
    if all_names().any(|known| known == name) {
        let document = mistakes(&[name.to_owned()], &[])?;
        return Ok(Some(report::mistakes::text(&document, true)));
    }
    // Results name a deviation without the word before it.
    let of_deviation = if name.starts_with("deviation/") { name.to_owned() } else { format!("deviation/{name}") };
    let deviations = NamedDeviation::named(&Filter::new(&[of_deviation])?);
    if !name.contains('*') && !deviations.is_empty() {
        return Ok(Some(deviations.iter().map(|one| format!("{}\n  {}\n", one.name(), one.reason())).collect()));
    }
    if let Some((words, means)) = GLOSSARY.iter().find(|(words, _)| words.split(", ").any(|word| word == name)) {
        return Ok(Some(format!("{words}: {means}\n")));
    }
    let probes: Vec<&Probe> = PROBES.iter().filter(|probe| probe.id().starts_with(&format!("{name}/"))).collect();
    if !probes.is_empty() {
        return of_probes(name, &probes).map(Some);
    }
    let below = |member: &&Member| member.spec.family() == name || member.spec.group() == name;
    let members: Vec<&Member> = catalogue.iter().filter(below).collect();
    if members.is_empty() { Ok(None) } else { family(name, &members).map(Some) }
}

/// A table of special values: what is asked, and what is promised of it.
fn of_probes(name: &str, probes: &[&Probe]) -> anyhow::Result<String> {
    let mut text = format!("{name}: {} special values\n", probes.len());
    let mut table = TextTable::new(&[("", Align::Left), ("", Align::Left), ("promised", Align::Left)]);
    for probe in probes {
        table.row([probe.name.to_string(), probe.what.to_string(), probe.promise.words(probe.gives).to_string()]);
    }
    write!(text, "{}", table.text("  "))?;
    writeln!(text, "\n  lightmeter special    shows what each adapter gives")?;
    Ok(text)
}

/// How results write a ruling, `ruling 9`, as the name that it has here.
fn ruling_of(name: &str) -> Option<String> {
    let number = name.strip_prefix("ruling")?.trim_start_matches([' ', '-']);
    (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then(|| format!("ruling/{number}"))
}

/// What there is to say of a part of a name: of the one name that has it, or which names do; `None` where none has it.
pub(super) fn containing(part: &str, catalogue: &[Member]) -> anyhow::Result<Option<String>> {
    const LEAST: usize = 3;
    const MOST: usize = 40;
    let part = part.to_lowercase();
    let mut names = names(catalogue);
    let mut seen = BTreeSet::new();
    names.retain(|name| part.len() >= LEAST && name.to_lowercase().contains(&part) && seen.insert(name.clone()));
    match names.as_slice() {
        [] => Ok(None),
        [one] => about(one, catalogue),
        several => {
            let mut text = format!("{} names have `{part}` in them\n", several.len());
            several.iter().take(MOST).try_for_each(|name| writeln!(text, "  {name}"))?;
            if several.len() > MOST {
                writeln!(text, "  …")?;
            }
            Ok(Some(text))
        }
    }
}

/// The id of a formula that may be named by an alias.
fn canonical(name: &str) -> String {
    aliases().find_map(|(alias, id)| (alias == name).then_some(id)).unwrap_or_else(|| name.to_owned())
}

/// What `show` can be asked for besides cases, to tell somebody who typed another name.
pub(super) fn names(catalogue: &[Member]) -> Vec<String> {
    let mut names: Vec<String> = catalogue.iter().map(|member| member.spec.id.clone()).collect();
    names.extend(SCENES.iter().map(|(name, _)| format!("scene/{name}")));
    names.extend(all_names().map(str::to_owned));
    names.extend(NamedDeviation::named(&Filter::default()).iter().map(|one| one.name().to_owned()));
    let classes: BTreeSet<String> =
        PROBES.iter().filter_map(|probe| Some(probe.id().rsplit_once('/')?.0.to_owned())).collect();
    names.extend(classes);
    names.extend(GLOSSARY.iter().flat_map(|(words, _)| words.split(", ")).map(str::to_owned));
    names.extend(RULINGS.iter().map(|ruling| format!("ruling/{}", ruling.number)));
    names
}

/// A formula: what it computes of what, where it is from, at which inputs it is hard, and how it is got wrong.
fn formula(name: &str, member: &Member) -> anyhow::Result<String> {
    let spec = &member.spec;
    let mut text = format!("{}\n", spec.id);
    if name != spec.id {
        text = format!("{name}, which is the same as {}\n", spec.id);
    }
    writeln!(text, "  {}", spec.text)?;
    writeln!(text, "  source: {}{}", spec.source, explained(spec.source))?;
    for rule in spec.rules() {
        writeln!(text, "  rule: {rule}")?;
    }
    writeln!(text, "\ninputs")?;
    for input in spec.inputs {
        let (shape, domain, means) = (input.shape.name(), input.domain, spec.input_means(input));
        let unit = with_unit(input.unit);
        writeln!(text, "  {:<14} {shape}{unit}: {means}; {domain}", input.name)?;
    }
    writeln!(text, "outputs")?;
    for output in spec.outputs {
        let unit = with_unit(output.unit);
        writeln!(text, "  {:<14} {}{unit}: {}", output.name, output.shape.name(), spec.output_means(output))?;
    }
    text += &dialects(&spec.id)?;
    if !spec.hard.is_empty() {
        writeln!(text, "hard cases")?;
    }
    for hard in spec.hard.iter() {
        let naive =
            hard.naive.map(|naive| format!("; {} fails there: {}", naive.formula, naive.fails)).unwrap_or_default();
        writeln!(text, "  {:<26} {}{naive}", hard.name, hard.pins)?;
    }
    text += &boundaries(spec)?;
    for common in COMMON.iter().filter(|common| common.id == spec.id) {
        writeln!(text, "what it is used for\n  {}", common.what)?;
        for (other, told) in common.confused_with {
            writeln!(text, "  commonly confused with {other}, {told}")?;
        }
    }
    text += &named_mistakes(member)?;
    if !spec.function.is_empty() {
        writeln!(
            text,
            "in WGSL: {}.wgsl, `{}`; the reference: reference/src/{}.rs",
            spec.family(),
            spec.function,
            spec.family()
        )?;
    }
    let case = spec.hard.first().map_or_else(|| "random/000000".into(), |hard| format!("hard/{}", hard.name));
    if matches!(spec.kind, Kind::Arithmetic) {
        writeln!(text, "\nlightmeter show {} --wgsl", spec.id)?;
    }
    writeln!(text, "lightmeter show {}/{case}\nlightmeter run {}", spec.id, spec.id)?;
    Ok(text)
}

/// The mistakes that are known by name in a formula.
fn named_mistakes(member: &Member) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    let (derived, mistakes): (Vec<&Fault>, Vec<&Fault>) =
        concerning(member).into_iter().partition(|fault| fault.is_generated);
    if !mistakes.is_empty() {
        let names: Vec<&str> = mistakes.iter().map(|fault| fault.name).collect();
        writeln!(text, "mistakes that are known by name\n  {}", names.join(", "))?;
    }
    if !derived.is_empty() {
        writeln!(
            text,
            "  {} more follow from its steps: lightmeter mistakes --formula {}",
            derived.len(),
            member.spec.id
        )?;
    }
    Ok(text)
}

/// What its boundary cases come close to.
fn boundaries(spec: &Spec) -> anyhow::Result<String> {
    let (mut text, names) = (String::new(), boundary_names(spec));
    if !names.is_empty() {
        writeln!(text, "boundaries, each with {DRAWN} cases close to it, on it, or close to another one too")?;
    }
    for names in names.chunks(4) {
        writeln!(text, "  {}", names.join("; "))?;
    }
    Ok(text)
}

/// Who computes a formula's subject by which form.
fn dialects(id: &str) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for one in DIALECTS.iter().filter(|one| one.concern(id)) {
        writeln!(text, "who computes what: {}", one.title.to_lowercase())?;
        for form in one.forms {
            let own = if form.formulas.contains(&id) { " (this formula)" } else { "" };
            writeln!(text, "  {:<14} {}{own}", form.speaker.name(), form.what)?;
        }
    }
    Ok(text)
}

/// What a source's name stands for.
fn explained(source: &str) -> String {
    let of: Vec<&str> = SOURCES.iter().filter(|one| source.contains(one.name)).map(|one| one.name).collect();
    if of.is_empty() { String::new() } else { format!(" (`lightmeter show {}` says what that is)", of[0]) }
}

/// A family: its formulas, a line each.
fn family(name: &str, members: &[&Member]) -> anyhow::Result<String> {
    const MOST: usize = 60;
    let mut text = format!("{name}: {} formulas\n", members.len());
    for member in members.iter().take(MOST) {
        writeln!(text, "  {:<30} {}", member.spec.id, member.spec.text)?;
    }
    if members.len() > MOST {
        writeln!(text, "  … `lightmeter list {name}` lists all of them")?;
    }
    Ok(text)
}

/// A scene: what it shows, what it calls for, and how to draw and judge it.
fn of_scene(scene: &Loaded) -> anyhow::Result<String> {
    let name = &scene.name;
    let mut text = format!("scene/{name}: {}\n  {}\n", scene.title, scene.shows);
    let target = &scene.frame.target;
    writeln!(text, "  {} × {} pixels, {}", target.width, target.height, target.format.name())?;
    let called: BTreeSet<String> = effects(&scene.frame)
        .iter()
        .flat_map(|called| called.effects.iter().map(|effect| effect.name().to_owned()))
        .collect();
    let called: Vec<String> = called.into_iter().collect();
    writeln!(
        text,
        "  effects that it calls for: {}",
        if called.is_empty() { "none".into() } else { called.join(", ") }
    )?;
    writeln!(
        text,
        "\nlightmeter effects {name}\nlightmeter render {name} --out {name}.png\nlightmeter show scene/{name} --wgsl\nlightmeter run scene/{name}"
    )?;
    Ok(text)
}

fn of_ruling(ruling: &Ruling) -> anyhow::Result<String> {
    let Ruling { number, title, document, right, why, forms } = ruling;
    let mut text = format!("ruling {number}: {title}\n");
    for (what, words) in [("documents", document), ("right", right), ("why", why), ("forms", forms)] {
        writeln!(text, "  {what:<10} {words}")?;
    }
    Ok(text)
}

/// The WGSL of a formula's function, or the composed shaders of a scene.
pub(super) fn wgsl(name: &str, catalogue: &[Member]) -> anyhow::Result<String> {
    let shaders = Shaders::built_in()?;
    let id = canonical(name);
    if let Some(member) = catalogue.iter().find(|member| member.spec.id == id) {
        let spec = &member.spec;
        let file = spec.file();
        let text = shaders.function_with_named(&file, spec.function);
        let Some(text) = text else { bail!("`{name}` is drawn by fixed hardware: no function computes it") };
        return Ok(format!("// {file}\n{text}\n"));
    }
    let Some(scene) = name.strip_prefix("scene/") else {
        bail!("`--wgsl` is of a formula or a scene, as `lighting/blinn` or `scene/phong`");
    };
    let loaded = load::builtin(scene)?;
    let composer = Composer::new(&shaders)?;
    let recipe = Recipe::of(ShaderForm::Composed);
    let (mut text, mut told) = (String::new(), BTreeSet::new());
    for (called, draw) in effects(&loaded.frame).iter().zip(&loaded.frame.draws) {
        let composition = composer.compose(called.effects, recipe, 0)?;
        if told.insert(composition.source.clone()) {
            writeln!(
                text,
                "// {}, and whatever else calls for: {}\n{}",
                draw.name, composition.effects, composition.source
            )?;
        }
    }
    Ok(text)
}
