//! Which shaders are judged: the built-in ones, those of a folder, or a single one as somebody wrote it.

use super::foreign;
use super::terminal::level;
use super::values::setting;
use super::{quoted, say};
use anyhow::{Context as _, bail};
use clap::Args;
use lightmeter::bench::OwnShader as Beside;
use lightmeter::cases::{Kind, Spec};
use lightmeter::device::Code;
use lightmeter::document::hash;
use lightmeter::document::report::{BoundVariable, Group, HeldInput, JudgedAs, MistakePlace, Report, ShaderUse};
use lightmeter::faults::{Fault, Touched};
use lightmeter::filter::Filter;
use lightmeter::options::{Adapted, Constant};
use lightmeter::report::Level;
use lightmeter::select::{Member, Shard, catalogue, select};
use lightmeter::subject_gpu::{code_of, shaders_of};
use lightmeter_adapt::bind::{AskedBinding, Bound, ShaderBinding};
use lightmeter_adapt::constant::numbers;
use lightmeter_adapt::place::{line_of_step, line_of_variable};
use lightmeter_adapt::{Part, in_language, stable_form};
use lightmeter_gpu::compose::Composer;
use lightmeter_gpu::{EFFECT_FILES, SCENE_FILES, Shaders};
use lightmeter_shaders::read::Language;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// The file of the formulas that a shader was bound to, and how (`[JudgedAs]` as JSON), in the folder of what it was made to.
pub(super) const BOUND: &str = "bound.json";
/// The file of its text without the functions that are not judged, there too.
pub(super) const JUDGED: &str = "judged";
/// Families of which a shader can be told to be one.
const IDENTIFIED: [&str; 7] = ["lighting", "fog", "attenuation", "color", "vector", "interpolation", "depth"];
/// Formulas that a single shader can be judged by in one command.
const MOST_FORMULAS: usize = 64;

/// Which shaders are judged.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ShaderChoice {
    /// Judge the WGSL in this folder in place of the built-in files of the same names
    #[arg(long, value_name = "DIR", conflicts_with_all = ["shader", "function"])]
    pub(crate) shaders: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) own: OwnShader,
}

/// A shader as somebody wrote it.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct OwnShader {
    /// Judge a shader as it is, in the place of the formula: GLSL (.frag, .vert, .glsl), WGSL or SPIR-V
    #[arg(long, value_name = "FILE")]
    shader: Option<PathBuf>,
    /// Judge a function of a shader's file in the place of the formula
    #[arg(long, value_name = "NAME@FILE", conflicts_with = "shader")]
    function: Option<OsString>,
    /// What a variable of the shader means: WGSL over the formula's inputs, as `lightDir=-direction`; again for several
    #[arg(long, value_name = "NAME=EXPRESSION", allow_hyphen_values = true)]
    bind: Vec<String>,
    /// An input of the formula that the shader has as a constant, as `shininess=32`, `ls=1,1,1` or `l=normalize(vec3(1, 2, 3))`, or in
    /// common with another one, as `ma=md`; again for several
    #[arg(long, value_name = "NAME=VALUE", value_parser = constant, allow_hyphen_values = true)]
    constant: Vec<(String, Constant)>,
}

/// Shaders that can be judged.
pub(crate) struct Accepted {
    /// The folder to read them from.
    pub(crate) folder: Option<PathBuf>,
    /// Whether it was made for this, and goes.
    is_made: bool,
    /// How formulas are judged of it.
    pub(crate) adapted: Vec<Adapted>,
}

impl Accepted {
    pub(crate) fn code(&self) -> anyhow::Result<Code> {
        Ok(code_of(self.folder.as_deref())?)
    }

    pub(crate) fn shaders(&self) -> anyhow::Result<Shaders> {
        Ok(self.folder.as_deref().map_or_else(Shaders::built_in, Shaders::from_dir)?)
    }
}

impl Drop for Accepted {
    fn drop(&mut self) {
        if let Some(folder) = self.folder.as_ref().filter(|_| self.is_made) {
            let _ = std::fs::remove_dir_all(folder);
        }
    }
}

/// Files whose functions a run takes from the suite itself, and why.
const UNJUDGED: [(&str, &str); 2] = [
    ("probe.wgsl", "the witnesses of known deviations are about the device, and so are evaluated by the built-in file"),
    ("technique.wgsl", "only `lightmeter bench` evaluates its functions"),
];

/// Says which edited files of a folder are not judged.
fn tell_unjudged(folder: &Path) -> anyhow::Result<()> {
    let (built_in, own) = (Shaders::built_in()?, Shaders::from_dir(folder)?);
    let text = |shaders: &Shaders, file: &str| {
        shaders.texts().find(|(name, _)| *name == file).map(|(_, text)| text.to_owned())
    };
    for (file, why) in UNJUDGED {
        if text(&built_in, file) != text(&own, file) {
            say(&format!("note: {} is not judged: {why}", folder.join(file).display()));
        }
    }
    if SCENE_FILES.iter().chain(&EFFECT_FILES).any(|(file, _)| text(&built_in, file) != text(&own, file)) {
        for (file, lines) in edited_beside_pictures(&built_in, &own)? {
            let lines = lines.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
            let place = if lines.is_empty() { String::new() } else { format!(":{lines}") };
            say(&format!(
                "note: {}{place} is edited and not judged: only the techniques of `lightmeter bench` and intermediate results use it",
                folder.join(file).display()
            ));
        }
    }
    Ok(())
}

/// The files of scenes that are edited where no picture shows it, with the lines that are new there; none where lines are only gone.
fn edited_beside_pictures(built_in: &Shaders, own: &Shaders) -> anyhow::Result<BTreeMap<String, BTreeSet<usize>>> {
    type Texts = BTreeMap<((usize, usize), String), Vec<(usize, String)>>;
    let of = |shaders: &Shaders| -> anyhow::Result<Texts> {
        let mut texts = Texts::new();
        for line in Composer::new(shaders)?.lines_beside_pictures()? {
            texts.entry((line.shader, line.file)).or_default().push((line.line, line.text));
        }
        Ok(texts)
    };
    let (known, found) = (of(built_in)?, of(own)?);
    let mut edited = BTreeMap::<String, BTreeSet<usize>>::new();
    for key in known.keys().chain(found.keys()).collect::<BTreeSet<_>>() {
        let [before, after] = [&known, &found].map(|texts| texts.get(key).map_or(&[][..], Vec::as_slice));
        if before.iter().map(|(_, text)| text).eq(after.iter().map(|(_, text)| text)) {
            continue;
        }
        let mut left: Vec<&String> = before.iter().map(|(_, text)| text).collect();
        let lines = edited.entry(key.1.clone()).or_default();
        for (line, text) in after {
            match left.iter().position(|known| *known == text) {
                Some(place) => drop(left.remove(place)),
                None => drop(lines.insert(*line)),
            }
        }
    }
    Ok(edited)
}

/// The hash of all files of a set of shaders, by their names and texts; `None` of the built-in ones.
pub(crate) fn hash_of(code: &Code) -> anyhow::Result<Option<String>> {
    let Some(shaders) = shaders_of(code) else { return Ok(None) };
    let texts =
        |shaders: &Shaders| -> String { shaders.texts().map(|(name, text)| format!("{name}\0{text}\0")).collect() };
    let (own, built_in) = (texts(shaders), texts(&Shaders::built_in()?));
    Ok((own != built_in).then(|| hash(own.as_bytes())))
}

impl ShaderChoice {
    /// Has processes of their own read and compile the shaders.
    pub(crate) fn accepted(&self, filter: &Filter, adapters: &[String], has_scenes: bool) -> anyhow::Result<Accepted> {
        if self.own.words()?.is_none() {
            if let Some(folder) = &self.shaders {
                foreign::accept(folder, adapters, has_scenes)?;
                tell_unjudged(folder)?;
            }
            return Ok(Accepted { folder: self.shaders.clone(), is_made: false, adapted: vec![] });
        }
        let formulas = formulas(filter)?;
        self.own.check_constants(&formulas)?;
        self.own.adapted_to(&formulas, adapters)
    }

    /// What a command that judges the same again is given.
    pub(crate) fn rerun(&self) -> anyhow::Result<String> {
        let mut text = String::new();
        if let Some(folder) = &self.shaders {
            let _ = write!(text, " --shaders '{}'", folder.to_string_lossy().replace('\'', r"'\''"));
        }
        for word in self.own.words()?.into_iter().flatten() {
            let _ = write!(text, " {}", quoted(&word.to_string_lossy()));
        }
        Ok(text)
    }
}

/// Whether a shader can be this formula: one of arithmetic alone.
pub(super) fn is_identified(spec: &Spec) -> bool {
    IDENTIFIED.contains(&spec.family())
        && !spec.function.is_empty()
        && spec.selectors.is_empty()
        && matches!(spec.kind, Kind::Arithmetic)
}

/// An input's numbers, an expression that gives them, or another input's name.
pub(crate) fn constant(text: &str) -> Result<(String, Constant), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE, as shininess=32, ls=1,1,1 or ma=md")?;
    let (name, value) = (name.trim(), value.trim());
    let is_name = value.chars().all(|c| c.is_alphanumeric() || c == '_') && value.starts_with(char::is_alphabetic);
    if is_name && !["inf", "nan"].contains(&value.to_lowercase().as_str()) {
        return Ok((name.into(), Constant::SameAs(value.into())));
    }
    if let Ok((name, values)) = setting(text) {
        return Ok((name, Constant::Numbers(values)));
    }
    let values = numbers(value).ok_or_else(|| {
        format!(
            "`{value}` is no list of numbers, as 1,1,1, and no constant expression of WGSL, as normalize(vec3(1, 2, 3)) or 1.0/3.0"
        )
    })?;
    Ok((name.into(), Constant::Numbers(values)))
}

/// A constant as it is given on the command line.
pub(super) fn written(constant: &Constant) -> String {
    match constant {
        Constant::Numbers(values) => values.iter().map(f32::to_string).collect::<Vec<_>>().join(","),
        Constant::SameAs(other) => other.clone(),
    }
}

/// The line of a shader in which a mistake is made, where a single one can be it.
fn line_of(text: &str, fault: &'static Fault, member: &Member, variables: &[BoundVariable]) -> Option<MistakePlace> {
    let (line, code) = fault.touched(member).into_iter().find_map(|touched| match touched {
        Touched::Step(step) => line_of_step(text, step),
        Touched::Input(input) => {
            let has = |is: &str| is.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == input);
            let names: Vec<&str> = variables.iter().filter(|one| has(&one.is)).map(|one| one.name.as_str()).collect();
            line_of_variable(text, &names)
        }
        Touched::Output => None,
    })?;
    Some(MistakePlace { mistake: fault.name.into(), line, code: code.into() })
}

/// The formulas that a filter names, which a single shader can stand in for.
fn formulas(filter: &Filter) -> anyhow::Result<Vec<String>> {
    let catalogue = catalogue();
    let found: Vec<String> = if filter.is_empty() {
        vec![]
    } else {
        select(&catalogue, filter, 1, Shard::WHOLE)
            .into_iter()
            .map(|one| catalogue[one.member].spec.id.clone())
            .collect()
    };
    if found.is_empty() || found.len() > MOST_FORMULAS {
        let found = found.len();
        bail!(
            "a shader is judged by formulas that are named, such as `lighting/blinn`; the filter selects {found}. `lightmeter identify FILE` \
             says which formula it is"
        );
    }
    Ok(found)
}

impl OwnShader {
    /// A shader, or a function of its file.
    pub(crate) fn new(
        file: PathBuf,
        function: Option<&str>,
        bind: Vec<String>,
        constant: Vec<(String, Constant)>,
    ) -> Self {
        let named = function.map(|name| {
            let mut words = OsString::from(format!("{name}@"));
            words.push(&file);
            words
        });
        Self { shader: named.is_none().then_some(file), function: named, bind, constant }
    }

    /// Has processes of their own make it the function of formulas, of every one that it can be bound to where none is named.
    pub(crate) fn adapted_to(&self, formulas: &[String], adapters: &[String]) -> anyhow::Result<Accepted> {
        let (accepted, told) = self.made_functions_of(formulas)?;
        if level() > Level::Quiet && !formulas.is_empty() {
            say(told.trim_end());
        }
        if !accepted.adapted.is_empty() {
            foreign::accept(accepted.folder.as_deref().unwrap_or(Path::new("")), adapters, false)?;
        }
        Ok(accepted)
    }

    /// The same without compiling it here, and what was told of its variables.
    pub(super) fn made_functions_of(&self, formulas: &[String]) -> anyhow::Result<(Accepted, String)> {
        static MADE: AtomicU64 = AtomicU64::new(0);
        let name = format!("lightmeter-shader-{}-{}", std::process::id(), MADE.fetch_add(1, Ordering::Relaxed));
        let folder = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&folder).with_context(|| format!("cannot write {}", folder.display()))?;
        let mut accepted = Accepted { folder: Some(folder.clone()), is_made: true, adapted: vec![] };
        let mut given = vec![OsString::from("adapt-shader"), folder.clone().into_os_string()];
        given.extend(self.words()?.unwrap_or_default());
        given.extend(formulas.iter().map(OsString::from));
        given.extend(formulas.is_empty().then(|| OsString::from("--every")));
        let told = foreign::watched_child(&given, &self.part()?.1)?;
        let [bound, judged] = [BOUND, JUDGED].map(|name| std::fs::read_to_string(folder.join(name)));
        accepted.adapted = self.adapted(serde_json::from_str(&bound?)?, &judged?);
        Ok((accepted, told))
    }

    /// The same as words of a command line; `None` where no shader is given.
    fn words(&self) -> anyhow::Result<Option<Vec<OsString>>> {
        let mut words: Vec<OsString> = match (&self.shader, &self.function) {
            // A name that begins with a hyphen would be read as an option.
            (Some(file), _) if file.as_os_str().as_encoded_bytes().starts_with(b"-") => {
                let mut joined = OsString::from("--shader=");
                joined.push(file);
                vec![joined]
            }
            (Some(file), _) => vec!["--shader".into(), file.into()],
            (_, Some(function)) => vec!["--function".into(), function.clone()],
            (None, None) if self.bind.is_empty() => return Ok(None),
            (None, None) => bail!(
                "`--bind` says what a variable of a shader means: give the shader by `--shader FILE` or `--function NAME@FILE`"
            ),
        };
        for bind in &self.bind {
            words.extend(["--bind".into(), bind.into()]);
        }
        for (name, constant) in &self.constant {
            words.extend(["--constant".into(), format!("{name}={}", written(constant)).into()]);
        }
        Ok(Some(words))
    }

    /// Refuses constants where cases are not those of a run.
    pub(crate) fn without_constants(&self) -> anyhow::Result<()> {
        if let Some((name, _)) = self.constant.first() {
            bail!(
                "`--constant {name}` applies to `run`, `bench` and `identify` alone; a sweep sets its other inputs by `--set`"
            );
        }
        Ok(())
    }

    /// The same for a bench, which measures it beside the suite's own; `None` where no shader is given.
    pub(crate) fn beside(&self, accepted: &Accepted) -> anyhow::Result<Option<Beside>> {
        let Ok((part, file)) = self.part() else { return Ok(None) };
        let name = match part {
            Part::Function(name) => name,
            Part::Shader => file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        };
        Ok(Some(Beside { name, shaders: accepted.shaders()?, adapted: accepted.adapted.clone() }))
    }

    /// The formulas that have all constants as inputs.
    pub(super) fn with_constants<'a>(&self, formulas: impl Iterator<Item = &'a Spec>) -> anyhow::Result<Vec<&'a Spec>> {
        let formulas: Vec<&Spec> = formulas.collect();
        let is_fit = |own: &Self, spec: &Spec| own.check_constants(std::slice::from_ref(&spec.id)).is_ok();
        let fitting: Vec<&Spec> = formulas.iter().copied().filter(|spec| is_fit(self, spec)).collect();
        if !fitting.is_empty() {
            return Ok(fitting);
        }
        let text = |(name, value): &(String, Constant)| format!("{name}={}", written(value));
        for one in &self.constant {
            let alone = Self { constant: vec![one.clone()], ..Self::default() };
            if !formulas.iter().any(|spec| is_fit(&alone, spec)) {
                let has = |spec: &&&Spec| spec.inputs.iter().any(|input| input.name == one.0);
                let Some(spec) = formulas.iter().find(has) else {
                    bail!("`--constant {}`: no formula has an input `{}`", text(one), one.0);
                };
                alone.check_constants(std::slice::from_ref(&spec.id))?;
            }
        }
        bail!(
            "no formula has all of these as inputs, each once: {}",
            self.constant.iter().map(text).collect::<Vec<_>>().join(", ")
        )
    }

    /// Refuses constants that are no inputs, or of another size.
    pub(super) fn check_constants(&self, formulas: &[String]) -> anyhow::Result<()> {
        let catalogue = catalogue();
        for spec in catalogue.iter().map(|member| &member.spec).filter(|spec| formulas.contains(&spec.id)) {
            let components = |name: &str, of: &str| {
                let found = spec.inputs.iter().find(|input| input.name == name);
                found.map(|input| input.shape.components()).with_context(|| {
                    let names: Vec<&str> = spec.inputs.iter().map(|input| input.name).collect();
                    format!(
                        "`--constant {of}`: {} has no input `{name}`; expected one of {}",
                        spec.id,
                        names.join(", ")
                    )
                })
            };
            for (k, (name, constant)) in self.constant.iter().enumerate() {
                let others = &self.constant[..k];
                if others.iter().any(|(other, _)| other == name) {
                    bail!("`--constant {name}` is given twice");
                }
                if let Constant::SameAs(is) = constant {
                    let is_back =
                        |(other, back): &(String, Constant)| other == is && matches!(back, Constant::SameAs(_));
                    if is == name || others.iter().any(is_back) {
                        bail!(
                            "`--constant {name}={is}`: of two inputs that are the same only one is said to be the other"
                        );
                    }
                }
                let expected = components(name, name)?;
                let given = match constant {
                    Constant::Numbers(values) => values.len(),
                    Constant::SameAs(other) => components(other, name)?,
                };
                if given != expected {
                    bail!("`--constant {name}`: {given} of {expected} numbers of `{name}` in {}", spec.id);
                }
            }
        }
        Ok(())
    }

    /// What a shader is judged as, and by what.
    pub(super) fn judged_as(&self, spec: &Spec, binding: &ShaderBinding) -> JudgedAs {
        let variable = |bound: &Bound| BoundVariable {
            name: bound.name.clone(),
            is: bound.expression.clone(),
            found: bound.found,
        };
        let is_given = |(name, value): &(_, Option<_>)| value.is_none().then(|| ToString::to_string(name));
        JudgedAs {
            id: spec.id.clone(),
            variables: binding.bound.iter().map(variable).collect(),
            not_given: binding.outputs.iter().filter_map(is_given).collect(),
            unbound: self.unbound(binding).map(str::to_owned).collect(),
            held: self.constant.iter().map(held).collect(),
            mistakes: vec![],
        }
    }

    /// The inputs that no variable and no constant stands for.
    pub(super) fn unbound<'a>(&self, binding: &'a ShaderBinding) -> impl Iterator<Item = &'a str> {
        let is_constant = |name: &&str| self.constant.iter().any(|(own, _)| own == name);
        binding.unused.iter().copied().filter(move |name| !is_constant(name))
    }

    /// How formulas are judged.
    fn adapted(&self, bound: Vec<JudgedAs>, text: &str) -> Vec<Adapted> {
        let of = |one: JudgedAs| Adapted {
            id: one.id,
            missing: one.not_given,
            constants: self.constant.clone(),
            variables: one.variables,
            unbound: one.unbound,
            text: text.into(),
        };
        bound.into_iter().map(of).collect()
    }

    /// The stable form of each formula that the shader fails, in the shader's language.
    pub(crate) fn suggested(&self, adapted: &[Adapted], report: &Report) -> anyhow::Result<String> {
        let language = Language::of(&self.part()?.1)?;
        let (shaders, catalogue) = (Shaders::built_in()?, catalogue());
        let mut told = String::new();
        for Adapted { id, .. } in adapted {
            let fails = report.groups.iter().any(|group| group.id == *id && group.totals.failed > 0);
            let Some(spec) = catalogue.iter().map(|member| &member.spec).find(|spec| fails && spec.id == *id) else {
                continue;
            };
            let file = spec.file();
            if let Some(form) = stable_form(&shaders, &file, spec.function, language) {
                writeln!(told, "the stable form of {id}:\n\n{}", form.trim_end())?;
                continue;
            }
            match in_language(&shaders, &file, spec.function, language).filter(|_| spec.stable.is_some()) {
                Some(form) => writeln!(told, "{id} is itself a stable form:\n\n{}", form.trim_end())?,
                None => writeln!(told, "no stable form of {id} is known")?,
            }
        }
        Ok(told)
    }

    /// What is told of it in a report: what it was bound to, and where in its text the mistakes are made, as far as that can be told.
    pub(crate) fn used(&self, adapted: &[Adapted], report: &Report) -> Option<ShaderUse> {
        let (part, file) = self.part().ok()?;
        let catalogue = catalogue();
        let formula = |adapted: &Adapted| {
            let id = &adapted.id;
            let named = report.groups.iter().filter(|group| group.id == *id).find(|group| !group.mistakes().is_empty());
            let member = catalogue.iter().find(|member| member.spec.id == *id);
            let faults = named.into_iter().flat_map(Group::mistakes).filter_map(|name| Fault::by_name(&name));
            let mistakes = member.into_iter().zip(std::iter::repeat(faults)).flat_map(|(member, faults)| {
                faults.filter_map(|fault| line_of(&adapted.text, fault, member, &adapted.variables))
            });
            JudgedAs {
                id: id.clone(),
                variables: adapted.variables.clone(),
                not_given: adapted.missing.clone(),
                unbound: adapted.unbound.clone(),
                held: adapted.constants.iter().map(held).collect(),
                mistakes: mistakes.collect(),
            }
        };
        let function = if let Part::Function(name) = part { Some(name) } else { None };
        let formulas = adapted.iter().map(formula).collect();
        Some(ShaderUse { file: file.display().to_string(), function, formulas })
    }

    /// The inputs that are held in all cases, as they are asked for.
    pub(crate) fn held(&self) -> Vec<String> {
        let mut held: Vec<String> =
            self.constant.iter().map(|(name, constant)| format!("{name}={}", written(constant))).collect();
        held.sort();
        held
    }

    /// What is judged, and of which file.
    pub(crate) fn part(&self) -> anyhow::Result<(Part, PathBuf)> {
        if let Some(file) = &self.shader {
            return Ok((Part::Shader, file.clone()));
        }
        let function = self.function.as_ref().context("no shader is given")?;
        let text = function.to_str().context("the name of a function is text")?;
        let (name, file) = text
            .split_once('@')
            .with_context(|| format!("`--function {text}` names no file; expected NAME@FILE, as `shade@my.wgsl`"))?;
        Ok((Part::Function(name.into()), file.into()))
    }

    /// The bindings that are asked for.
    pub(crate) fn asked(&self) -> anyhow::Result<Vec<AskedBinding>> {
        let asked = |text: &String| {
            let (name, expression) = text.split_once('=').with_context(|| {
                format!("`--bind {text}` binds nothing; expected NAME=EXPRESSION, as `lightDir=-direction`")
            })?;
            Ok(AskedBinding { name: name.trim().into(), expression: expression.trim().into() })
        };
        self.bind.iter().map(asked).collect()
    }
}

/// An input that a shader does not take, as a report has it.
fn held((name, constant): &(String, Constant)) -> HeldInput {
    let name = name.clone();
    match constant {
        Constant::Numbers(numbers) => {
            HeldInput { name, bits: numbers.iter().map(|number| number.to_bits()).collect(), same_as: None }
        }
        Constant::SameAs(other) => HeldInput { name, bits: vec![], same_as: Some(other.clone()) },
    }
}
