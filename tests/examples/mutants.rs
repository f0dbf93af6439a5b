//! Judges mutants of the shaders, and prints what became of them. `--update` writes those that survive to `tests/mutants.txt`.

#![expect(clippy::print_stdout, reason = "the table is what it is for")]

use lightmeter::adapters;
use lightmeter_tests::mutants::{Campaign, Mutant, MutantClass, SURVIVORS, Survivors, mutants};

use std::collections::{BTreeMap, BTreeSet};
use std::process::ExitCode;
use std::time::Instant;

const HELP: &str = "usage: ./x mutants [--only FILE] [--survivors] [--every N] [--update]

Changes one constant, operator or argument of the built-in shaders at a time, and tells whether a default run fails.

  --only FILE   mutants of this file alone, such as fog.wgsl or effects/spot.wgsl
  --survivors   only mutants that tests/mutants.txt names: are they still not noticed?
  --every N     only each N-th mutant
  --update      write the survivors to tests/mutants.txt

Exit code: 0, or 1 where a mutant survives that tests/mutants.txt does not name, or 2 where an argument is wrong.";

/// What is asked for.
struct Asked {
    only: Option<String>,
    are_survivors: bool,
    every: usize,
    update: bool,
}

fn asked() -> Result<Asked, String> {
    let mut asked = Asked { only: None, are_survivors: false, every: 1, update: false };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or_else(|| format!("{argument} takes a value"));
        match argument.as_str() {
            "--only" => asked.only = Some(value()?),
            "--every" => {
                let text = value()?;
                let number = text.parse().ok().filter(|&every: &usize| every > 0);
                asked.every = number.ok_or_else(|| format!("--every `{text}`: expected a whole number above 0"))?;
            }
            "--survivors" => asked.are_survivors = true,
            "--update" => asked.update = true,
            _ => return Err(format!("unexpected argument `{argument}`")),
        }
    }
    Ok(asked)
}

fn main() -> ExitCode {
    if std::env::args().any(|argument| argument == "--help" || argument == "-h") {
        println!("{HELP}");
        return ExitCode::SUCCESS;
    }
    let asked = match asked() {
        Ok(asked) => asked,
        Err(message) => {
            eprintln!("{message}\n\n{HELP}");
            return ExitCode::from(2);
        }
    };
    match judge_all(&asked) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

/// Whether every survivor is known.
fn judge_all(asked: &Asked) -> Result<bool, String> {
    let subject = adapters::open(&[]).map_err(|error| error.to_string())?.swap_remove(0);
    let mut campaign = Campaign::new(subject).map_err(|error| error.to_string())?;
    let files: Vec<(String, String)> =
        campaign.shaders().texts().map(|(file, text)| (file.to_owned(), text.to_owned())).collect();
    let of_file = |(file, text): &(String, String)| mutants(file, text);
    let mut known = Survivors::read().map_err(|error| format!("{SURVIVORS}: {error}"))?;
    let is_asked = |mutant: &Mutant| {
        asked.only.as_ref().is_none_or(|only| *only == mutant.file)
            && (!asked.are_survivors || known.class(mutant).is_some())
    };
    let all: Vec<Mutant> = files.iter().flat_map(of_file).filter(is_asked).step_by(asked.every).collect();
    if all.is_empty() {
        let names: Vec<&str> = files.iter().map(|(file, _)| file.as_str()).collect();
        return Err(format!("no such mutants of that file; the files are {}", names.join(", ")));
    }
    let mut counts: BTreeMap<&str, BTreeMap<MutantClass, usize>> = BTreeMap::new();
    let (mut is_all_known, clock) = (true, Instant::now());
    for (place, mutant) in all.iter().enumerate() {
        let began = Instant::now();
        let finding = campaign.judge(mutant).map_err(|error| format!("{}: {error}", mutant.name()))?;
        *counts.entry(&mutant.file).or_default().entry(finding).or_default() += 1;
        let is_known = known.allows(mutant, finding);
        if !matches!(finding, MutantClass::Killed | MutantClass::Invalid) {
            let mark = if is_known { "" } else { " (new)" };
            println!("{finding:<9}{}{mark}", mutant.name());
        }
        is_all_known &= is_known;
        known.note(mutant, finding);
        if (place + 1) % 50 == 0 {
            let seconds = clock.elapsed().as_secs();
            eprintln!("{} of {} mutants in {seconds} s, the last in {:.1?}", place + 1, all.len(), began.elapsed());
        }
    }
    print_table(&counts);
    println!("{} mutants in {} s", all.len(), clock.elapsed().as_secs());
    if asked.update {
        let names: BTreeSet<String> = files.iter().flat_map(of_file).map(|mutant| mutant.name()).collect();
        known.retain(|name| names.contains(name));
        known.write().map_err(|error| format!("{SURVIVORS}: {error}"))?;
        return Ok(true);
    }
    Ok(is_all_known)
}

fn print_table(counts: &BTreeMap<&str, BTreeMap<MutantClass, usize>>) {
    let heads: String = MutantClass::ALL.iter().map(|finding| format!("{finding:>10}")).collect();
    println!("\n{:<36}{heads}", "file");
    let mut sums = [0; MutantClass::ALL.len()];
    for (file, of_file) in counts {
        let row: Vec<usize> =
            MutantClass::ALL.iter().map(|finding| of_file.get(finding).copied().unwrap_or_default()).collect();
        sums.iter_mut().zip(&row).for_each(|(sum, count)| *sum += count);
        println!("{file:<36}{}", row.iter().map(|count| format!("{count:>10}")).collect::<String>());
    }
    println!("{:<36}{}", "all", sums.iter().map(|count| format!("{count:>10}")).collect::<String>());
}
