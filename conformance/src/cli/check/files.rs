//! Which files are meant: folders and globs as the shaders that are there.

use anyhow::{Context as _, bail};
use globset::GlobBuilder;
use lightmeter_shaders::read::is_shader;
use std::path::{Path, PathBuf};

/// Folders within each other.
const MOST_DEPTH: usize = 32;
/// Files of a command.
const MOST_FILES: usize = 20_000;

/// All files, in the order in which they are named, those of a folder by name.
pub(super) fn all(named: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    let mut found: Vec<PathBuf> = vec![];
    for path in named {
        let text = path.to_string_lossy();
        if path.is_dir() {
            let before = found.len();
            walk(path, 0, &is_shader, &mut found)?;
            if found.len() == before {
                bail!("{}: there is no shader in this folder", path.display());
            }
        } else if !path.exists() && text.contains(['*', '?', '[', '{']) {
            let glob = GlobBuilder::new(&text).literal_separator(true).build();
            let glob = glob.with_context(|| format!("`{text}` is no glob"))?.compile_matcher();
            let start: PathBuf = path
                .components()
                .take_while(|own| !own.as_os_str().to_string_lossy().contains(['*', '?', '[', '{']))
                .collect();
            let start = if start.as_os_str().is_empty() { Path::new(".") } else { &start };
            let before = found.len();
            let fits = |own: &Path| glob.is_match(own) || own.strip_prefix(".").is_ok_and(|own| glob.is_match(own));
            walk(start, 0, &fits, &mut found)?;
            if found.len() == before {
                bail!("`{text}`: no file is called so");
            }
        } else {
            // One that is not there is told with the others.
            found.push(path.clone());
        }
        if found.len() > MOST_FILES {
            bail!("these are more than {MOST_FILES} files");
        }
    }
    Ok(found)
}

fn walk(folder: &Path, depth: usize, fits: &dyn Fn(&Path) -> bool, found: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    let entries = std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut entries: Vec<_> = entries.collect::<Result<_, _>>()?;
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let (path, kind) = (entry.path(), entry.file_type()?);
        // A link may lead back.
        if kind.is_dir() && depth < MOST_DEPTH && entry.file_name() != ".git" {
            walk(&path, depth + 1, fits, found)?;
        } else if kind.is_file() && fits(&path) && found.len() <= MOST_FILES {
            found.push(path);
        }
    }
    Ok(())
}
