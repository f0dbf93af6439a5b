//! The page on the self-test, made from the JSON of `lightmeter selftest`: the kill matrix, and the suite's resolution.

use crate::selftest::{MistakeRow, percent, rows, smallest};
use lightmeter_document::selftest::{
    Clean, Finding, Kill, Mistake, NamedFrom, OffBy, Record, Resolution, SceneRecord, SceneResolution,
    SelftestDocument, UnitFinding, UnitRow, family_of,
};
use lightmeter_document::{Document as _, Word, thousands};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{Result as Written, Write};

/// What the page is of.
#[derive(Clone, Debug)]
pub struct SelftestRun {
    record: Record,
    mistakes: Vec<Mistake>,
    named_from: Option<NamedFrom>,
    calibration: Vec<Resolution>,
    rows: Vec<UnitRow>,
    scenes: Option<SceneRecord>,
    scene_calibration: Vec<SceneResolution>,
    /// The command, where the file says it.
    pub(crate) command: Option<String>,
    /// The seed of the random cases, likewise.
    pub(crate) seed: Option<u64>,
    /// The version of lightmeter.
    pub(crate) version: Option<Word>,
    /// When it was made.
    pub(crate) made_at: Option<String>,
}

impl SelftestRun {
    /// Reads the JSON.
    ///
    /// # Errors
    /// Where it is another document, interrupted, of the blend unit alone, or of mistakes that this version does not have.
    pub fn read(json: &str) -> Result<Self, String> {
        let document = SelftestDocument::read(json).map_err(|error| error.to_string())?;
        if let Some(interrupted) = document.interrupted {
            return Err(format!("it was interrupted: {interrupted}; expected one that is complete"));
        }
        let (Some(kills), Some(clean)) = (document.kills, document.clean) else {
            return Err("it is of the blend unit alone; expected formulas too".into());
        };
        if document.mistakes.is_empty() {
            return Err("it does not name its mistakes, as older versions did not; run the self-test anew".into());
        }
        let run = Self {
            record: Record { kills, clean, is_complete: true },
            mistakes: document.mistakes,
            named_from: document.named_from,
            calibration: document.calibration.unwrap_or_default(),
            rows: document.rows,
            scenes: document.scenes,
            scene_calibration: document.scene_calibration,
            command: document.command,
            seed: document.seed,
            version: document.version,
            made_at: document.made_at,
        };
        let is_told = |kill: &&Kill| run.mistakes.iter().any(|mistake| mistake.name == kill.fault);
        match run.record.kills.iter().find(|kill| !is_told(kill)) {
            Some(kill) => Err(format!("no mistake `{}`: the file is of another version", kill.fault)),
            None => Ok(run),
        }
    }
}

impl SelftestRun {
    /// Whether every mistake is caught, and nothing right is flagged.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.record.is_good()
    }

    /// How many mistakes in formulas are caught, in a sentence.
    pub(crate) fn counted(&self) -> String {
        let kills = &self.record.kills;
        let caught = kills.iter().filter(|kill| kill.finding != Finding::Survived).count();
        let flagged = self.record.clean.iter().filter(|clean| clean.failed > 0 || clean.systematic.is_some()).count();
        let [caught, tried, flagged] = [caught, kills.len(), flagged].map(|count| thousands(count as u64));
        format!(
            "{caught} of {tried} combinations of a mistake and a formula are caught; {flagged} formulas without a mistake are flagged."
        )
    }
}

/// The page in Markdown.
///
/// # Errors
/// Where the writer fails.
pub fn markdown(run: &SelftestRun, out: &mut impl Write) -> Written {
    writeln!(out, "# What the suite catches\n")?;
    writeln!(
        out,
        "Every named mistake is made by an implementation that is right otherwise, in every formula that it concerns, and\n\
         judged like any renderer. Made from a run's JSON:\n"
    )?;
    writeln!(out, "```\n./x selftest --calibrate --format json --out selftest.json")?;
    writeln!(out, "./x page selftest selftest.json --out docs/selftest.md\n```\n")?;
    body(run, out)
}

/// The page but for its title and how it was made.
///
/// # Errors
/// Where the writer fails.
pub fn body(run: &SelftestRun, out: &mut impl Write) -> Written {
    totals(&run.record, out)?;
    matrix(run, out)?;
    aliases(&run.record, out)?;
    clean(&run.record, out)?;
    if let Some(scenes) = &run.scenes {
        drawn(scenes, out)?;
    }
    unit(&run.rows, out)?;
    resolution(run, out)?;
    scene_resolution(&run.scene_calibration, out)
}

/// Words in a cell of a table, where a bar would end the cell.
fn cell(words: &str) -> String {
    words.replace('|', "\\|")
}

fn totals(record: &Record, out: &mut impl Write) -> Written {
    let (total, survived) = (record.kills.len(), record.count(Finding::Survived));
    let named = record.count(Finding::Named);
    let aliases = record.kills.iter().filter(|kill| kill.alias).count();
    let percent = percent(named, total);
    let made: BTreeSet<&str> = record.kills.iter().map(|kill| kill.fault.as_str()).collect();
    writeln!(
        out,
        "{} mistakes make {} combinations with the formulas that they concern: {} are caught, {} survive. The\n\
         first diagnosis is the right one for {}, {percent:.1} %; in {} of these it is one of the same values in every \
         case.\n",
        thousands(made.len() as u64),
        thousands(total as u64),
        thousands((total - survived) as u64),
        thousands(survived as u64),
        thousands(named as u64),
        thousands(aliases as u64),
    )
}

fn matrix(SelftestRun { record, mistakes, .. }: &SelftestRun, out: &mut impl Write) -> Written {
    writeln!(out, "## The mistakes\n")?;
    writeln!(
        out,
        "By family: in how many formulas a mistake is made; bold where one is not told by its name. *Cases* is how many suffice \
         to\ncatch it, in the order of a run: the median over its formulas, and the most.\n"
    )?;
    let families: Vec<&str> = record
        .families()
        .into_iter()
        .filter(|family| record.kills.iter().any(|kill| family_of(&kill.formula) == *family))
        .collect();
    writeln!(out, "| mistake | what it does | {} | cases | most | seen in |", families.join(" | "))?;
    writeln!(out, "|---|---|{}--:|--:|---|", "--:|".repeat(families.len()))?;
    for MistakeRow { name, says, seen_in, kills } in rows(record, mistakes) {
        write!(out, "| {name} | {} |", cell(says))?;
        for family in &families {
            let of: Vec<&&Kill> = kills.iter().filter(|kill| family_of(&kill.formula) == *family).collect();
            let named = of.iter().filter(|kill| kill.finding == Finding::Named).count();
            match of.len() {
                0 => write!(out, " |")?,
                all if all == named => write!(out, " {all} |")?,
                all => write!(out, " **{named} of {all}** |")?,
            }
        }
        let (median, most) = smallest(&kills);
        writeln!(out, " {median} | {most} | {} |", seen_in)?;
    }
    let missed: Vec<&Kill> = record.kills.iter().filter(|kill| kill.finding != Finding::Named).collect();
    if !missed.is_empty() {
        writeln!(out, "\nCaught, but told otherwise at first:\n")?;
    }
    for kill in missed {
        let survived = if kill.finding == Finding::Survived { " **survived**:" } else { "" };
        writeln!(out, "* {} in {}:{survived} {}", kill.fault, kill.formula, kill.sentence)?;
    }
    writeln!(out)
}

fn aliases(record: &Record, out: &mut impl Write) -> Written {
    let mut by_pair: BTreeMap<(&str, String), BTreeSet<&str>> = BTreeMap::new();
    for kill in record.kills.iter().filter(|kill| kill.alias) {
        let told = kill.diagnosis.join(" and ");
        by_pair.entry((&kill.fault, told)).or_default().insert(&kill.formula);
    }
    if by_pair.is_empty() {
        return Ok(());
    }
    writeln!(out, "## Mistakes of the same values\n")?;
    writeln!(out, "In these formulas two mistakes cannot be told apart, whatever the case:\n")?;
    writeln!(out, "| mistake | told as | in |\n|---|---|---|")?;
    for ((fault, told), formulas) in by_pair {
        const MOST_NAMED: usize = 4;
        let named: Vec<&str> = formulas.iter().copied().take(MOST_NAMED).collect();
        let rest = formulas.len() - named.len();
        let more = if rest > 0 { format!(" and {rest} more") } else { String::new() };
        writeln!(out, "| {fault} | {told} | {}{more} |", named.join(", "))?;
    }
    writeln!(out)
}

fn clean(record: &Record, out: &mut impl Write) -> Written {
    writeln!(out, "## Without a mistake\n")?;
    writeln!(
        out,
        "The same formulas, dialects among them, by the embedded implementation and by evaluations that draw order, rounding,\n\
         form, fusion and flush at random, as freely as the rules permit:\n"
    )?;
    writeln!(out, "| family | formulas | verdicts | failed | group verdicts |\n|---|--:|--:|--:|--:|")?;
    for family in record.families() {
        let of: Vec<&Clean> = record.clean.iter().filter(|clean| family_of(&clean.formula) == family).collect();
        let verdicts: u64 = of.iter().map(|clean| clean.verdicts).sum();
        let failed: u64 = of.iter().map(|clean| clean.failed).sum();
        let systematic = of.iter().filter(|clean| clean.systematic.is_some()).count();
        if !of.is_empty() {
            writeln!(out, "| {family} | {} | {verdicts} | {failed} | {systematic} |", of.len())?;
        }
    }
    writeln!(out)
}

fn drawn(record: &SceneRecord, out: &mut impl Write) -> Written {
    let [caught, named] = record.counts();
    writeln!(out, "\n## Mistakes of whole renderers\n")?;
    writeln!(
        out,
        "Each is made by the reference renderer in f32 in every built-in scene, where it changes anything that is not legal. \
         {} mistakes\nare caught in {caught} images; the first diagnosis names {named} of them, {:.1} %, or one that draws the \
         same image.\n",
        record.rows.len(),
        percent(named, caught)
    )?;
    writeln!(
        out,
        "| mistake | what it does | scenes that catch it | named in | taken for another in |\n|---|---|--:|--:|---|"
    )?;
    for row in &record.rows {
        let others: Vec<&str> = row.others.iter().filter_map(|other| other.split(':').next()).collect();
        let [caught, named] = [row.caught.len(), row.named.len()];
        writeln!(out, "| {} | {} | {caught} | {named} | {} |", row.fault, cell(&row.says), others.join(", "))?;
    }
    for alarm in &record.alarms {
        writeln!(out, "\n**False alarm**: {alarm} fails and nothing is wrong.")?;
    }
    Ok(())
}

fn unit(rows: &[UnitRow], out: &mut impl Write) -> Written {
    if rows.is_empty() {
        return Ok(());
    }
    let mut targets: Vec<&str> = vec![];
    let mut names: Vec<&str> = vec![];
    for row in rows {
        for (list, name) in [(&mut targets, &row.target), (&mut names, &row.fault)] {
            if !list.contains(&name.as_ref()) {
                list.push(name);
            }
        }
    }
    writeln!(out, "## The blend unit\n")?;
    writeln!(out, "| mistake | {} |\n|---|{}", targets.join(" | "), "---|".repeat(targets.len()))?;
    for name in names {
        write!(out, "| {name} |")?;
        for target in &targets {
            let finding = rows.iter().find(|row| row.fault == name && row.target == *target);
            let word = finding
                .map_or("", |row| if row.finding == UnitFinding::NotApplicable { "–" } else { row.finding.name() });
            write!(out, " {word} |")?;
        }
        writeln!(out)?;
    }
    writeln!(out)
}

fn resolution(SelftestRun { calibration, named_from, .. }: &SelftestRun, out: &mut impl Write) -> Written {
    let Some(NamedFrom { cases, least_z, least_share }) = named_from.filter(|_| !calibration.is_empty()) else {
        return Ok(());
    };
    writeln!(out, "## Resolution\n")?;
    let relative = calibration.iter().filter(|row| !row.parameter.contains('.') && row.error == OffBy::Scale);
    writeln!(
        out,
        "The smallest error of a parameter that a run of {cases} cases names: relative (*scale*) or absolute (*offset*), by a\n\
         *single* verdict, some case leaving its interval, and by the *group* verdict, a regression of the residuals on the\n\
         formula's derivatives that names what lies {least_z} standard errors from 0 and shifts the answers by {least_share} of \
         their\ntolerance at least. Inputs as a whole; the JSON has each of their numbers.\nOf {} an error of a thousandth\nor less is named.\n",
        share_within(relative.map(|row| row.single.into_iter().chain(row.group).reduce(f64::min)), 1e-3),
    )?;
    writeln!(
        out,
        "| formula | parameter | scale, single | group | offset, single | group |\n|---|---|--:|--:|--:|--:|"
    )?;
    let number = |x: Option<f64>| x.map_or("–".into(), |x| format!("{x:.1e}"));
    let mut seen = BTreeSet::new();
    for resolution in calibration.iter().filter(|resolution| !resolution.parameter.contains('.')) {
        let name = resolution.name();
        if !seen.insert((&resolution.formula, name.clone())) {
            continue;
        }
        write!(out, "| {} | {name} |", resolution.formula)?;
        for error in [OffBy::Scale, OffBy::Offset] {
            let found = calibration.iter().find(|other| {
                other.formula == resolution.formula
                    && other.parameter == resolution.parameter
                    && other.is_output == resolution.is_output
                    && other.error == error
            });
            let (single, group) = found.map_or((None, None), |found| (found.single, found.group));
            write!(out, " {} | {} |", number(single), number(group))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// The smallest errors that the images of scenes tell.
fn scene_resolution(resolutions: &[SceneResolution], out: &mut impl Write) -> Written {
    if resolutions.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n## Resolution of scenes\n")?;
    let is_float = |row: &&SceneResolution| row.target.contains("float");
    let (on_floats, on_bytes): (Vec<&SceneResolution>, Vec<&SceneResolution>) = resolutions.iter().partition(is_float);
    writeln!(
        out,
        "The smallest share by which a parameter of a scene may be off and its image tells it, in the size in which a run of everything draws\n\
         scenes: by a single *pixel*, and by the *image*, which is a pixel or all pixels together. What all pixels of a float target tell together\n\
         is reported and fails nothing. On floats {} are told by 0.05 % or less, and of 8 bits {} by 0.2 % or less.\n",
        share_within(on_floats.iter().map(|row| row.image), 5e-4),
        share_within(on_bytes.iter().map(|row| row.image), 2e-3),
    )?;
    writeln!(out, "The least of each parameter, and the scene that tells it:\n")?;
    writeln!(out, "| parameter | floats | scene | 8 bits | scene |\n|---|--:|---|--:|---|")?;
    let number = |x: Option<f64>| x.map_or("–".into(), |x| format!("{x:.1e}"));
    let mut parameters: Vec<&str> = vec![];
    resolutions.iter().for_each(|row| {
        if !parameters.contains(&&*row.parameter) {
            parameters.push(&row.parameter);
        }
    });
    for parameter in parameters {
        write!(out, "| {parameter} |")?;
        for rows in [&on_floats, &on_bytes] {
            let of_it = rows.iter().filter(|row| row.parameter == parameter);
            let told = of_it.filter_map(|row| Some((row.image?, &*row.scene)));
            let least = told.min_by(|(a, _), (b, _)| a.total_cmp(b));
            write!(out, " {} | {} |", number(least.map(|(x, _)| x)), least.map_or("", |(_, scene)| scene))?;
        }
        writeln!(out)?;
    }
    writeln!(out, "\nAll of them:\n\n| scene | target | parameter | pixel | image |\n|---|---|---|--:|--:|")?;
    for SceneResolution { scene, target, parameter, pixel, image } in resolutions {
        writeln!(out, "| {scene} | {target} | {parameter} | {} | {} |", number(*pixel), number(*image))?;
    }
    Ok(())
}

/// How many of some smallest errors are no greater than one.
fn share_within(errors: impl Iterator<Item = Option<f64>>, most: f64) -> String {
    let (mut within, mut of) = (0, 0);
    for error in errors {
        of += 1;
        within += usize::from(error.is_some_and(|error| error <= most));
    }
    format!("{within} of {of} parameters")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_document_makes_no_page() {
        for (json, message) in [
            ("{", "not JSON"),
            (r#"{"schema":"lightmeter.run/1"}"#, "expected lightmeter.selftest/1"),
            (r#"{"schema":"lightmeter.selftest/1","rows":[]}"#, "of the blend unit alone"),
            (
                r#"{"schema":"lightmeter.selftest/1","kills":[],"clean":[],
                    "interrupted":{"under_way":"scene/phong","message":"a signal ended the self-test","signal":2}}"#,
                "it was interrupted: scene/phong was under way",
            ),
        ] {
            let error = SelftestRun::read(json).expect_err("it is no page's");
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn a_survivor_stands_out() {
        let kill = r#"{"fault":"fog-radial","formula":"fog/exp","finding":"survived","cases":9,"failing":0,"smallest":null,
            "first_case":null,"smallest_random":null,"diagnosis":[],"sentence":"nothing fails","alias":false}"#;
        let mistake = r#"{"name":"fog-radial","says":"fog uses radial distance"}"#;
        let json =
            format!(r#"{{"schema":"lightmeter.selftest/1","kills":[{kill}],"clean":[],"mistakes":[{mistake}]}}"#);
        let mut page = String::new();
        markdown(&SelftestRun::read(&json).expect("a run"), &mut page).expect("a string takes it");
        assert!(page.contains("fog-radial in fog/exp: **survived**: nothing fails"), "{page}");
        assert!(page.contains("| fog-radial | fog uses radial distance | **0 of 1** |"), "{page}");
    }
}
