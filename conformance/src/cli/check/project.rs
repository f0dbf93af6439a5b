//! The shaders of a project, as its `lightmeter.toml` says: which there are, and what they are read with.

use super::super::config::{self, Shaders};
use super::{Read, files};
use anyhow::bail;
use globset::GlobBuilder;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Files that are read with the same.
pub(super) struct Set {
    pub(super) files: Vec<PathBuf>,
    pub(super) read: Read,
}

/// The files of a command, by what they are read with. A file belongs to the first `[[shader]]` that has it; options win over what that says.
pub(super) fn sets(named: &[PathBuf], read: &Read) -> anyhow::Result<Vec<Set>> {
    let project = config::shaders()?;
    let entries = project.as_ref().map_or(&[][..], |own| &own.entries);
    let folder = project.as_ref().map_or(Path::new(""), |own| &own.folder);
    let mut sets: Vec<Set> = vec![];
    for entry in entries {
        sets.push(Set { files: vec![], read: joined(read, entry, folder)? });
    }
    sets.push(Set { files: vec![], read: read.clone() });
    if named.is_empty() {
        if entries.is_empty() {
            bail!(
                "no file is named; expected `lightmeter check FILE…`, or a lightmeter.toml with `[[shader]]` and its `files`"
            );
        }
        let mut seen = HashSet::new();
        for (entry, set) in entries.iter().zip(&mut sets) {
            let patterns: Vec<PathBuf> = entry.files.iter().map(|own| folder.join(own)).collect();
            let found = files::all(&patterns)?;
            set.files = found.into_iter().filter(|file| seen.insert(file.clone())).collect();
        }
    } else {
        for file in files::all(named)? {
            let own = entries.iter().position(|entry| has(entry, folder, &file)).unwrap_or(entries.len());
            sets[own].files.push(file);
        }
    }
    sets.retain(|set| !set.files.is_empty());
    Ok(sets)
}

/// What is read with an entry: its own, and before it what is given.
fn joined(given: &Read, entry: &Shaders, folder: &Path) -> anyhow::Result<Read> {
    let mut read = given.clone();
    for own in &entry.include {
        let own = folder.join(own);
        if !own.is_dir() {
            bail!("lightmeter.toml: `include` has `{}`, and there is no such folder", own.display());
        }
        read.include.push(own);
    }
    for (name, value) in &entry.define {
        let (name, value) = super::definition(&format!("{name}={value}"))
            .map_err(|why| anyhow::anyhow!("lightmeter.toml: `define`: {why}"))?;
        if !given.define.iter().any(|(own, _)| *own == name) {
            read.define.push((name, value));
        }
    }
    for name in &entry.accept {
        let name = super::accepted_name(name).map_err(|why| anyhow::anyhow!("lightmeter.toml: `accept`: {why}"))?;
        read.accept.push(name);
    }
    Ok(read)
}

/// Whether a file is one of an entry's.
fn has(entry: &Shaders, folder: &Path, file: &Path) -> bool {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let (Ok(folder), Ok(file)) = (folder.canonicalize(), file.canonicalize()) else { return false };
    let Ok(own) = file.strip_prefix(&folder) else { return false };
    entry.files.iter().any(|pattern| {
        let glob = GlobBuilder::new(pattern).literal_separator(true).build();
        own.starts_with(pattern) || glob.is_ok_and(|glob| glob.compile_matcher().is_match(own))
    })
}
