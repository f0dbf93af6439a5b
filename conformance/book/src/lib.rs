//! The book: what the suite does for people who look before they read.
//!
//! Its chapters and appendices are Markdown of the documentation folder. A page for each formula that is no blend state, for each equation, factor
//! and mode of blending, a gallery of scenes and the pages to look things up on are made from the catalogue, so that what they say is what is judged.

mod apart;
mod blend;
mod contents;
mod diagram;
mod errors;
mod figure;
mod formula;
mod grid;
mod lookup;
pub mod picture;
mod rule;
mod scenes;
mod search;
mod sketch;
mod texts;
mod wrong_scenes;

use contents::{Contents, Entry, Place, SEARCH};
use formula::{FormulaPage, Told, told};
use lightmeter_catalogue::scene::library::SCENES;
use lightmeter_catalogue::scene::load::{self, Loaded};
use lightmeter_catalogue::select::{Member, catalogue};
use lightmeter_files::whole;
use lightmeter_gpu::Shaders;
use lightmeter_scene::blend::{Equation, Factor};
use maud::{Markup, html};
use rayon::prelude::*;
use search::Found;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use texts::{PAGES, Text, flat};

/// A command of the command line.
#[derive(Clone, Debug)]
pub struct CommandHelp {
    /// Its name.
    pub name: String,
    /// What it does, on a line.
    pub about: String,
    /// What `--help` prints of it.
    pub help: String,
}

/// What the book is made of, beside what is judged.
#[derive(Clone, Debug)]
pub struct BookSources {
    /// The folder of the documentation.
    pub docs: PathBuf,
    /// The commands.
    pub commands: Vec<CommandHelp>,
    /// The exit codes, and what each means.
    pub exit_codes: Vec<(String, String)>,
    /// The schemas of the files that are read and written, by their names.
    pub schemas: Vec<(String, Value)>,
}

/// Why no book was made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BookError {
    /// A file of the documentation.
    #[error("cannot read {}: {message}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// A file of the book.
    #[error("cannot write {}: {message}", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// A scene or a shader that is built in.
    #[error("{0}")]
    BuiltIn(String),
}

/// The chapters at the beginning of the book.
const START: &[&str] = &["what-it-tells-you", "my-driver", "my-renderer", "my-shader", "in-ci", "on-several-machines"];
/// The chapters that explain.
const EXPLAINED: &[&str] =
    &["floats-and-what-is-legal", "condition-and-stability", "a-rasterisers-freedom", "gouraud-and-highlights"];

/// A page of the book in the making.
enum Made<'a> {
    /// A text of the documentation.
    Text(Text),
    /// A formula, and others that are told on the same page.
    Formula(&'a Member, Vec<&'a Member>),
    Equation(Equation),
    Factor(Factor),
    /// A page of the schema at this place.
    Schema(usize),
    Glossary,
    Dialects,
    Formulas,
    Mistakes,
    SceneMistakes,
    Gallery,
    CommandLine,
    ExitCodes,
    Schemas,
    SceneFiles,
}

/// Writes the book into a folder, and tells after each page how many there are and of how many; the number of its pages.
///
/// # Errors
/// Where the documentation cannot be read, or a file cannot be written.
pub fn write(out: &Path, sources: &BookSources, told: &(dyn Fn(usize, usize) + Sync)) -> Result<usize, BookError> {
    let catalogue = catalogue();
    let built_in = |error: &dyn std::fmt::Display| BookError::BuiltIn(error.to_string());
    let shaders = Shaders::built_in().map_err(|error| built_in(&error))?;
    let scenes: Vec<Loaded> = SCENES
        .iter()
        .map(|(name, _)| load::builtin(name).map_err(|error| built_in(&error)))
        .collect::<Result<_, BookError>>()?;
    let (contents, pages) = planned(sources, &catalogue)?;
    let wrong = wrong_scenes::wrong_scenes(&scenes);
    let (done, all) = (AtomicUsize::new(0), pages.len());
    let made: Vec<(Found, BTreeSet<String>)> = pages
        .par_iter()
        .map(|(path, made)| {
            let place = Place::new(path);
            let mut pictures = BTreeSet::new();
            let body = match made {
                Made::Text(text) => text.body(&place, &mut pictures),
                Made::Formula(member, others) => {
                    let page = FormulaPage { member, catalogue: &catalogue, shaders: &shaders, place };
                    html! { (page.body()) (alike(others)) }
                }
                Made::Equation(one) => blend::of_equation(*one, &catalogue, &shaders, place),
                Made::Factor(one) => blend::of_factor(*one, &catalogue, &shaders, place),
                Made::Schema(at) => lookup::schema(&sources.schemas[*at].0, &sources.schemas[*at].1),
                Made::Glossary => lookup::glossary(),
                Made::Dialects => lookup::dialects(&catalogue, &place),
                Made::Formulas => lookup::formulas(&catalogue, &place),
                Made::Mistakes => lookup::mistakes(&catalogue, &place),
                Made::SceneMistakes => wrong_scenes::page(&wrong, &place),
                Made::Gallery => scenes::gallery(&scenes, &place),
                Made::CommandLine => lookup::command_line(&sources.commands),
                Made::ExitCodes => lookup::exit_codes(&sources.exit_codes),
                Made::Schemas => lookup::schemas(sources, &place),
                Made::SceneFiles => lookup::scene_files(sources, &scenes[0], &place),
            };
            file(out, path, contents.framed(path, &body).as_bytes())?;
            told(done.fetch_add(1, Ordering::Relaxed) + 1, all);
            Ok((Found::new(path, contents.title(path), &body.0), pictures))
        })
        .collect::<Result<_, BookError>>()?;
    let (found, shown): (Vec<Found>, Vec<BTreeSet<String>>) = made.into_iter().unzip();
    file(out, SEARCH, contents.framed(SEARCH, &search::page(&found)).as_bytes())?;
    for name in shown.into_iter().flatten().collect::<BTreeSet<String>>() {
        let path = sources.docs.join(&name);
        let bytes = std::fs::read(&path).map_err(|error| BookError::Read { path, message: error.to_string() })?;
        file(out, &format!("pictures/{}", flat(&name)), &bytes)?;
    }
    scenes.par_iter().try_for_each(|scene| {
        let path = out.join(scenes::picture(scene));
        scenes::drawn(scene).write(&path).map_err(|error| BookError::Write { path, message: error.to_string() })
    })?;
    wrong.par_iter().try_for_each(|one| one.write(out))?;
    Ok(all)
}

/// Other formulas that a page stands for.
fn alike(others: &[&Member]) -> Markup {
    html! { @if !others.is_empty() {
        h2 #alike { "The same for others" }
        p { "These are told by the page above, and each is judged by itself:" }
        ul { @for member in others { li { code { (member.spec.id) } ": " (member.spec.text) } } }
    } }
}

fn file(out: &Path, path: &str, bytes: &[u8]) -> Result<(), BookError> {
    let path = out.join(path);
    let failed = |error: std::io::Error| BookError::Write { path: path.clone(), message: error.to_string() };
    std::fs::create_dir_all(path.parent().unwrap_or(out)).map_err(failed)?;
    whole(&path, bytes).map_err(failed)
}

/// The order of the book, and what each page is made from.
fn planned<'a>(
    sources: &BookSources,
    catalogue: &'a [Member],
) -> Result<(Contents, Vec<(String, Made<'a>)>), BookError> {
    let mut plan = Plan { contents: Contents::default(), pages: vec![] };
    let docs = &sources.docs;
    let chapter = |name: &str| {
        let path = if name == START[0] { "index.html".to_owned() } else { format!("{name}.html") };
        Text::read(docs, &format!("book/{name}.md")).map(|text| (path, text.title.clone(), Made::Text(text)))
    };
    let text = |path: &str| {
        let (name, path) = PAGES.iter().find(|(_, page)| *page == path).copied().unwrap_or(("", ""));
        Text::read(docs, name).map(|text| (path.to_owned(), text.title.clone(), Made::Text(text)))
    };
    let own = |path: &str, title: &str, made: Made<'a>| (path.to_owned(), title.to_owned(), made);
    let mut start: Vec<_> = START.iter().map(|name| chapter(name)).collect::<Result<_, _>>()?;
    // Beside the renderer in another language.
    start.insert(3, text("rust-engine.html")?);
    plan.part("Start", start);
    let mut explained: Vec<_> = EXPLAINED.iter().map(|name| chapter(name)).collect::<Result<_, _>>()?;
    explained.push(own("glossary.html", "Glossary", Made::Glossary));
    explained.push(text("rulings.html")?);
    plan.part("Understand", explained);
    plan.part(
        "Formulas",
        vec![
            own("dialects.html", "Who computes what", Made::Dialects),
            own("mistakes.html", "Mistakes by name", Made::Mistakes),
            own("formula/index.html", "All formulas", Made::Formulas),
        ],
    );
    plan.formulas(catalogue);
    plan.part(
        "Look",
        vec![
            own("scenes.html", "Gallery of scenes", Made::Gallery),
            own("scene-mistakes.html", "Mistakes in scenes", Made::SceneMistakes),
            text("renderers.html")?,
            chapter("cost")?,
        ],
    );
    let mut reference = vec![
        own("reference/command-line.html", "The command line", Made::CommandLine),
        own("reference/exit-codes.html", "Exit codes", Made::ExitCodes),
        text("reference/protocol.html")?,
        own("reference/scene-files.html", "Scene files", Made::SceneFiles),
        own("reference/schemas.html", "Schemas", Made::Schemas),
    ];
    for (_, path) in PAGES.iter().filter(|(_, path)| path.starts_with("reference/") && !path.contains("protocol")) {
        reference.push(text(path)?);
    }
    plan.part("Reference", reference);
    for (at, (name, _)) in sources.schemas.iter().enumerate() {
        plan.below("schemas", format!("reference/schema/{name}.html"), format!("schema {name}"), Made::Schema(at));
    }
    let appendices = PAGES.iter().filter(|(_, path)| path.starts_with("appendix/")).map(|(_, path)| text(path));
    plan.part("Appendices", appendices.collect::<Result<_, _>>()?);
    plan.part("Take part", vec![chapter("contributing")?]);
    Ok((plan.contents, plan.pages))
}

/// The order of the book as it grows.
struct Plan<'a> {
    contents: Contents,
    pages: Vec<(String, Made<'a>)>,
}

impl<'a> Plan<'a> {
    fn part(&mut self, title: &'static str, pages: Vec<(String, String, Made<'a>)>) {
        let entries = pages
            .iter()
            .map(|(path, title, _)| Entry { path: path.clone(), title: title.clone(), family: None })
            .collect();
        self.contents.part(title, entries);
        self.pages.extend(pages.into_iter().map(|(path, _, made)| (path, made)));
    }

    /// A page that is listed beside pages of its own family alone.
    fn below(&mut self, family: &str, path: String, title: String, made: Made<'a>) {
        let entry = Entry { path: path.clone(), title, family: Some(family.to_owned()) };
        if let Some(part) = self.contents.parts.last_mut() {
            part.entries.push(entry);
        }
        self.pages.push((path, made));
    }

    /// The pages of all formulas, and of the equations and factors of blending.
    fn formulas(&mut self, catalogue: &'a [Member]) {
        for Told { path, member, others } in told(catalogue) {
            let title = if others.is_empty() { member.spec.id.clone() } else { member.spec.group().to_owned() };
            self.below(member.spec.family(), path, title, Made::Formula(member, others));
        }
        for one in Equation::ALL {
            self.below(
                "blend",
                format!("blend/equation/{}.html", one.name()),
                format!("equation {}", one.name()),
                Made::Equation(one),
            );
        }
        for factor in Factor::ALL {
            self.below(
                "blend",
                format!("blend/factor/{}.html", factor.name()),
                format!("factor {}", factor.name()),
                Made::Factor(factor),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::page_of;
    use std::collections::HashSet;

    /// Every formula is told somewhere: by a page of its own, or by those of its equation and its factors.
    #[test]
    fn every_formula_has_a_page() {
        let catalogue = catalogue();
        let mut plan = Plan { contents: Contents::default(), pages: vec![] };
        plan.contents.part("Formulas", vec![]);
        plan.formulas(&catalogue);
        let paths: HashSet<&str> = plan.pages.iter().map(|(path, _)| path.as_str()).collect();
        assert_eq!(paths.len(), plan.pages.len(), "no page stands twice");
        for member in &catalogue {
            let is_state = member.spec.family() == "blend" && member.spec.id.matches('/').count() > 1;
            match page_of(&member.spec) {
                Some(path) => assert!(paths.contains(path.as_str()), "{path}"),
                None => assert!(is_state, "{} has no page", member.spec.id),
            }
        }
    }

    /// Every link of the chapters and pages of the documentation leads to a page of the book.
    #[test]
    fn links_of_texts_lead_to_pages() {
        let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
        let schemas = std::fs::read_dir(docs.join("schemas")).expect("the schemas are published");
        let name = |entry: std::io::Result<std::fs::DirEntry>| {
            entry.ok()?.path().file_stem().map(|stem| (stem.to_string_lossy().into_owned(), Value::Null))
        };
        let sources =
            BookSources { docs, commands: vec![], exit_codes: vec![], schemas: schemas.filter_map(name).collect() };
        let catalogue = catalogue();
        let (_, pages) = planned(&sources, &catalogue).expect("the documentation is there");
        let paths: HashSet<&str> = pages.iter().map(|(path, _)| path.as_str()).collect();
        let mut links = 0;
        for (path, made) in &pages {
            let Made::Text(text) = made else { continue };
            let html = text.body(&Place::new(path), &mut BTreeSet::new()).0;
            for link in html.split("<a href=\"").skip(1).filter_map(|rest| rest.split('"').next()) {
                let page = link.split('#').next().unwrap_or_default();
                if page.is_empty() || page.contains("://") {
                    continue;
                }
                let page = page.trim_start_matches("../");
                assert!(paths.contains(page), "{path} links to {link}");
                links += 1;
            }
        }
        assert!(links > 20, "{links} links");
    }
}
