//! `lightmeter serve --playground`: judges shaders as they are typed into a browser's page, on that browser's GPU.

use super::identify::{CASES, candidates};
use super::shader::{OwnShader, constant, is_identified};
use super::{NothingToRun, Status};
use anyhow::Context as _;
use anyhow::{bail, ensure};
use lightmeter::arithmetic::Profile;
use lightmeter::book::picture::{FormulaPicture, png};
use lightmeter::browser::{PlayedFormula, PlayedLanguage, PlayedPicture, PlayedResult, PlayedShader, Session};
use lightmeter::device::DeviceError;
use lightmeter::document::event::{Silent, Stop};
use lightmeter::faults::Mistakes;
use lightmeter::files::lines;
use lightmeter::filter::Filter;
use lightmeter::image::LegalPixel;
use lightmeter::image::file::StoredImage;
use lightmeter::image::map::error_map;
use lightmeter::options::Options;
use lightmeter::report::html::embedded;
use lightmeter::report::{Level, text};
use lightmeter::rows::Rows;
use lightmeter::run::run;
use lightmeter::select::{Member, catalogue};
use lightmeter::subject::Subject;
use lightmeter::subject_gpu::browser::of_session;
use lightmeter_scene::target::TargetFormat;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// How often it is looked at whether the playground ends.
const LOOK: Duration = Duration::from_millis(200);
/// Formulas that are told besides the nearest one.
const MOST_TOLD: usize = 4;

/// Judges what is typed into the pages of all browsers that come, until a signal ends it.
pub(super) fn play(
    next: impl Fn() -> Option<Arc<Session>>,
    stop: &Stop,
    profile: &'static Profile,
) -> anyhow::Result<Status> {
    let mut playgrounds = vec![];
    while let Some(session) = next() {
        let stop = stop.clone();
        playgrounds.push(std::thread::spawn(move || Playground::new(session, stop, profile).serve()));
    }
    if playgrounds.is_empty() {
        return Err(NothingToRun("ended before a browser opened the page".into()).into());
    }
    for playground in playgrounds {
        playground.join().map_err(|_| anyhow::anyhow!("a playground ended by a panic, which stands above"))?;
    }
    Ok(Status::Success)
}

/// The playground of one browser.
struct Playground {
    session: Arc<Session>,
    subject: Subject,
    stop: Stop,
    profile: &'static Profile,
}

impl Playground {
    fn new(session: Arc<Session>, stop: Stop, profile: &'static Profile) -> Self {
        let formulas = catalogue().into_iter().map(|member| member.spec).filter(is_identified).map(|spec| spec.id);
        session.tell(|told| {
            told.says = "Type or paste a shader below.".into();
            told.playground = formulas.collect();
        });
        Self { subject: subject(&session), session, stop, profile }
    }

    fn serve(mut self) {
        while self.stop.signal().is_none() && !self.session.is_gone() {
            let Some(shader) = self.session.next_shader(LOOK) else { continue };
            let result = self.judged(&shader).unwrap_or_else(|error| {
                if error.downcast_ref().is_some_and(DeviceError::is_of_device) {
                    self.subject = subject(&self.session);
                }
                PlayedResult { refused: Some(format!("{error:#}")), ..PlayedResult::default() }
            });
            self.session.tell_of_shader(&result);
        }
        self.session.tell_the_end(
            "lightmeter has ended: nothing is judged any more. Start it again, and load this page's new address."
                .into(),
            None,
        );
    }

    /// Judges a shader by the formula that was chosen, or by all that its variables can be bound to.
    fn judged(&mut self, shader: &PlayedShader) -> anyhow::Result<PlayedResult> {
        let folder = tempfile::tempdir().context("cannot write a folder of its own")?;
        let name = match shader.language {
            PlayedLanguage::Wgsl => "shader.wgsl",
            PlayedLanguage::Glsl => "shader.frag",
        };
        let file = folder.path().join(name);
        std::fs::write(&file, &shader.text)?;
        let bare = |text: &str| words_of_page(&lines(text).replace(&format!("{}/", folder.path().display()), ""));
        let judged = self.judged_file(shader, &file);
        match judged {
            Ok(result) => Ok(PlayedResult { told: bare(&result.told), result: bare(&result.result), ..result }),
            Err(error) if error.downcast_ref::<DeviceError>().is_some() => Err(error),
            Err(error) => Ok(PlayedResult { refused: Some(bare(&format!("{error:#}"))), ..PlayedResult::default() }),
        }
    }

    fn judged_file(&mut self, shader: &PlayedShader, file: &Path) -> anyhow::Result<PlayedResult> {
        check(shader)?;
        let constants = shader.constant.iter().map(|text| constant(text).map_err(anyhow::Error::msg));
        let function = Some(shader.function.trim()).filter(|name| !name.is_empty());
        let own = OwnShader::new(file.into(), function, shader.bind.clone(), constants.collect::<Result<_, _>>()?);
        let formulas: Vec<String> = Some(shader.formula.clone()).filter(|id| !id.is_empty()).into_iter().collect();
        own.check_constants(&formulas)?;
        let (accepted, told) = own.made_functions_of(&formulas)?;
        let mut options = Options::by(accepted.code()?, None, 1, self.profile);
        let ids: Vec<&str> = accepted.adapted.iter().map(|adapted| adapted.id.as_str()).collect();
        options.filter = Filter::new(&ids)?;
        options.cases = CASES;
        options.diagnose = Some(&Mistakes);
        options.adapted.clone_from(&accepted.adapted);
        options.stop = self.stop.clone();
        let mut report = run(std::slice::from_mut(&mut self.subject), &options, &mut Silent)?;
        report.failures.iter_mut().for_each(|failure| failure.rerun.clear());
        if let Some(interrupted) = &report.interrupted {
            return Err(
                DeviceError::Failed(format!("the shader was not judged to its end: {}", interrupted.message)).into()
            );
        }
        let candidates = candidates(&report, &accepted.adapted);
        let nearest = candidates.first().map(|candidate| candidate.formula.as_str());
        let picture = match accepted.adapted.iter().find(|adapted| Some(adapted.id.as_str()) == nearest) {
            Some(adapted) => {
                let member = catalogue().into_iter().find(|member| member.spec.id == adapted.id);
                member.map(|member| self.picture(&adapted.applied(member), &options)).transpose()?.flatten()
            }
            None => None,
        };
        let told_of = candidates.iter().take(1 + MOST_TOLD).map(|candidate| PlayedFormula {
            id: candidate.formula.clone(),
            verdicts: candidate.verdicts,
            failed: candidate.failed,
            why: candidate.explanation.clone().or_else(|| candidate.problem.clone()),
            missing: candidate.missing.clone(),
        });
        let mut result = String::new();
        let style = text::Style { detail: text::Detail::Families, timing: false, is_told: false, level: Level::Normal };
        text::write(&report, style, &mut result)?;
        let told = nearest.map(|id| told_of_formula(&told, id)).unwrap_or_default();
        Ok(PlayedResult { refused: None, told, formulas: told_of.collect(), result, picture })
    }

    /// What a formula draws by the reference and by the shader; `None` where it gives no colour.
    fn picture(&mut self, member: &Member, options: &Options) -> Result<Option<PlayedPicture>, DeviceError> {
        let Some(mut picture) = FormulaPicture::of(member).filter(|picture| !picture.lacks(&member.missing)) else {
            return Ok(None);
        };
        picture.rows().for_each(|row| member.hold(row));
        let inputs: Vec<f32> = picture.rows().flat_map(|row| row.iter().copied()).collect();
        let (stride, of_each) = (member.spec.input_len(), member.spec.output_len());
        let count = inputs.len() / stride;
        let Some(values) = self.values(member, options, &inputs, count)? else { return Ok(None) };
        let mut exact = vec![0.0; count * of_each];
        for (row, out) in inputs.chunks_exact(stride).zip(exact.chunks_exact_mut(of_each)) {
            member.formula.reference(row, out);
        }
        let mut legal = vec![lightmeter::arithmetic::Accept::ANY; count * of_each];
        member.formula.intervals(&inputs, stride, options.profile, &mut legal);
        let [low, high]: [Vec<f64>; 2] =
            [legal.iter().map(|legal| legal.low()).collect(), legal.iter().map(|legal| legal.high()).collect()];
        let of = |outputs: &[f64]| picture.colors(outputs, of_each);
        let (width, [exact, values, low, high]) = (of(&exact).0, [&exact, &values, &low, &high].map(|all| of(all).1));
        let stored = |colors: &[Option<[f64; 3]>]| StoredImage {
            width,
            format: TargetFormat::Rgba32Float,
            pixels: colors.iter().map(units).collect(),
        };
        let expected: Vec<LegalPixel> = low
            .iter()
            .zip(&high)
            .map(|(low, high)| LegalPixel { low: units(low), high: units(high), is_marked: false })
            .collect();
        let map = error_map(&stored(&values), &stored(&exact), &expected);
        let of_map =
            |(pixel, drawn): (&[f64; 4], &Option<[f64; 3]>)| drawn.map(|_| std::array::from_fn(|k| pixel[k] / 255.0));
        let errors = map.pixels.iter().zip(&exact).map(of_map).collect();
        let is_wrong = |(k, value): (usize, &[f64; 4])| {
            (0..4).any(|c| !(expected[k].low[c] <= value[c] && value[c] <= expected[k].high[c]))
        };
        Ok(Some(PlayedPicture {
            caption: picture.caption(member),
            wrong: stored(&values).pixels.iter().enumerate().filter(|&(k, value)| is_wrong((k, value))).count(),
            drawn: exact.iter().flatten().count(),
            files: [exact, values, errors].map(|colors| embedded("image/png", &png(width, &colors))),
        }))
    }

    /// The outputs of rows by the shader; `None` where no stage takes them.
    fn values(
        &mut self,
        member: &Member,
        options: &Options,
        inputs: &[f32],
        count: usize,
    ) -> Result<Option<Vec<f64>>, DeviceError> {
        let Some(device) = self.subject.device_mut() else { return Ok(None) };
        let stages = device.compile(&options.code, member)?;
        let Some(work) = stages.into_iter().find_map(|(_, work)| work.ok()) else { return Ok(None) };
        let of = vec![0; count];
        let rows = Rows {
            members: &[member],
            of: &of,
            cases: &[],
            inputs,
            selected: inputs,
            outputs: member.spec.output_len(),
        };
        let job = device.submit(&work, &rows)?;
        let words = device.finish(&work, job, &rows)?;
        Ok(Some(words.into_iter().map(|word| f32::from_bits(word).into()).collect()))
    }
}

/// Refuses what the command line of the process that reads the shader could take for something else.
fn check(shader: &PlayedShader) -> anyhow::Result<()> {
    let PlayedShader { function, formula, .. } = shader;
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    ensure!(
        function.trim().chars().all(is_word),
        "`{function}` is no function's name: leave the field empty to judge the whole shader"
    );
    let is_known = |member: Member| is_identified(&member.spec) && member.spec.id == *formula;
    if !formula.is_empty() && !catalogue().into_iter().any(is_known) {
        bail!("there is no formula `{formula}` that a shader can be judged by");
    }
    Ok(())
}

/// What the variables of a shader were taken for by one formula, of what was told of all.
fn told_of_formula(told: &str, id: &str) -> String {
    let (mut text, mut is_of_it) = (String::new(), false);
    for line in told.lines() {
        if !line.starts_with(' ') {
            is_of_it = line.contains(&format!(" judged as {id}."));
        }
        if is_of_it {
            text += line;
            text.push('\n');
        }
    }
    text
}

/// A message that names options of the command line, with the fields of the page in their place.
fn words_of_page(text: &str) -> String {
    let text = text
        .replace("name a function by `--function NAME@FILE`", "write the name of a function into the field Function")
        .replace("name one by `--function NAME@FILE`", "write the name of one into the field Function")
        .replace("by `--bind 'NAME=EXPRESSION'`", "by a line NAME=EXPRESSION in the field Variables")
        .replace("said by `--constant ", "said in the field Constants by the line `")
        .replace("`--constant ", "the constant `");
    let line = |line: &str| match (line.split_once("--bind '"), line.rfind('\'')) {
        (Some((before, _)), Some(end)) => {
            let start = before.len() + "--bind '".len();
            let (before, after) = (before.strip_suffix('`').unwrap_or(before), &line[end + 1..]);
            format!(
                "{before}the line {} in the field Variables{}",
                &line[start..end],
                after.strip_prefix('`').unwrap_or(after)
            )
        }
        _ => line.to_owned(),
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

fn subject(session: &Arc<Session>) -> Subject {
    of_session("browser".into(), session.clone())
}

/// A colour as a pixel; what is not drawn is clear.
fn units(color: &Option<[f64; 3]>) -> [f64; 4] {
    color.map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_the_command_line_are_told_as_fields_of_the_page() {
        for (text, expected) in [
            (
                "  If l points the other way: --bind 'l=-l'",
                "  If l points the other way: the line l=-l in the field Variables",
            ),
            (
                "`--bind 'd=foo(('`: expected an expression",
                "the line d=foo(( in the field Variables: expected an expression",
            ),
            (
                "Say what is meant by `--bind 'NAME=EXPRESSION'`, in WGSL",
                "Say what is meant by a line NAME=EXPRESSION in the field Variables, in WGSL",
            ),
            (
                "it has no main; name a function by `--function NAME@FILE`: it has f",
                "it has no main; write the name of a function into the field Function: it has f",
            ),
            ("is said by `--constant la=VALUE`, where", "is said in the field Constants by the line `la=VALUE`, where"),
        ] {
            assert_eq!(words_of_page(text), expected);
        }
    }

    #[test]
    fn the_variables_of_one_formula_are_told() {
        let told = "a is judged as fog/exp. What:\n  x  distance\na is judged as fog/exp2. What:\n  x  y\n  z\n";
        assert_eq!(told_of_formula(told, "fog/exp2"), "a is judged as fog/exp2. What:\n  x  y\n  z\n");
        assert_eq!(told_of_formula(told, "fog/linear"), "");
    }
}
