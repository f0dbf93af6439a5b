//! Files that are written whole or not at all: beside their place first, and moved there when the disk has them.

use std::ffi::OsString;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// What the name of a file begins with that is not in its place yet; the number of its process follows.
const BESIDE: &str = ".lightmeter-";
/// What it ends with.
const PART: &str = ".part";

/// A file that is being written. What stands in its place stays there until [`Whole::finish`]; dropped before that, nothing is left.
#[derive(Debug)]
pub struct Whole {
    file: File,
    path: PathBuf,
    /// Where it is written for the time being; `None` where it is written in its place, which is a pipe or a device.
    beside: Option<PathBuf>,
}

impl Whole {
    /// Begins a file. A pipe or a device is written as it is: `/dev/stdout`.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn create(path: &Path) -> io::Result<Self> {
        let about = std::fs::metadata(path).ok();
        if about.as_ref().is_some_and(std::fs::Metadata::is_dir) {
            return Err(io::Error::other("it is a folder"));
        }
        if about.as_ref().is_some_and(|about| !about.is_file()) {
            let file = OpenOptions::new().write(true).open(path)?;
            return Ok(Self { file, path: path.into(), beside: None });
        }
        // Of a link the file that it leads to is replaced, not the link.
        let path = path.canonicalize().unwrap_or_else(|_| path.into());
        let folder = folder_of(&path);
        remove_left(&folder);
        let beside = folder.join(fresh_name());
        let file = OpenOptions::new().write(true).create_new(true).open(&beside)?;
        let whole = Self { file, path, beside: Some(beside) };
        if let Some(about) = about {
            // Who may not write the file in its place shall not replace it.
            drop(OpenOptions::new().append(true).open(&whole.path)?);
            whole.file.set_permissions(about.permissions())?;
        }
        Ok(whole)
    }

    /// Moves the file to its place, once the disk has it.
    ///
    /// # Errors
    /// Where it cannot be written to its end.
    pub fn finish(mut self) -> io::Result<()> {
        self.file.flush()?;
        if let Some(beside) = &self.beside {
            self.file.sync_all()?;
            std::fs::rename(beside, &self.path)?;
            self.beside = None;
            // The name is on the disk when its folder is. Some file systems cannot be asked for that.
            let _ = File::open(folder_of(&self.path)).and_then(|folder| folder.sync_all());
        }
        Ok(())
    }
}

impl Write for Whole {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for Whole {
    fn drop(&mut self) {
        if let Some(beside) = &self.beside {
            let _ = std::fs::remove_file(beside);
        }
    }
}

/// Writes a file whole or not at all.
///
/// # Errors
/// Where it cannot be written. What stood there stands there still.
pub fn whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = Whole::create(path)?;
    file.write_all(bytes)?;
    file.finish()
}

/// Checks that a file can be written, before a long computation whose result goes there. The check changes no file.
///
/// # Errors
/// Where it cannot.
pub fn can_be_written(path: &Path) -> io::Result<()> {
    let is_other = std::fs::metadata(path).is_ok_and(|about| !about.is_file() && !about.is_dir());
    // A pipe that is opened may wait for its reader.
    if is_other { Ok(()) } else { Whole::create(path).map(drop) }
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.into(),
        _ => ".".into(),
    }
}

/// A name that no other file of this process has, nor one of another that is alive.
fn fresh_name() -> OsString {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    format!("{BESIDE}{}-{count}{PART}", std::process::id()).into()
}

/// Since when nothing was written to a file whose process is not to be found: it may be in another container.
const LEFT_FOR: Duration = Duration::from_secs(60);

/// Removes what processes left in a folder that were killed. Where it cannot be told which are alive, all stays.
fn remove_left(folder: &Path) {
    if !Path::new("/proc/self").exists() {
        return;
    }
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let rest = name.to_str().and_then(|name| name.strip_prefix(BESIDE)?.strip_suffix(PART));
        let process = rest.and_then(|rest| rest.split_once('-')?.0.parse::<u32>().ok());
        let is_gone = process.is_some_and(|process| !Path::new(&format!("/proc/{process}")).exists());
        let written = entry.metadata().and_then(|about| about.modified());
        let is_old = written.is_ok_and(|written| written.elapsed().is_ok_and(|since| since > LEFT_FOR));
        if is_gone && is_old {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("lightmeter-whole-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("it can be made");
        folder
    }

    fn names(folder: &Path) -> Vec<OsString> {
        std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name()).collect()
    }

    #[test]
    fn a_file_is_there_whole_or_not_at_all() {
        let folder = folder("all");
        let path = folder.join("out.json");
        whole(&path, b"first").expect("it can be written");
        let mut second = Whole::create(&path).expect("it can be begun");
        second.write_all(b"sec").expect("it can be written");
        assert_eq!(std::fs::read(&path).expect("it is there"), b"first");
        drop(second);
        assert_eq!((std::fs::read(&path).expect("it is there"), names(&folder).len()), (b"first".to_vec(), 1));
        whole(&path, b"second").expect("it can be written");
        assert_eq!(std::fs::read(&path).expect("it is there"), b"second");
        can_be_written(&folder.join("other")).expect("it can be");
        can_be_written(&folder.join("none").join("other")).expect_err("there is no such folder");
        assert_eq!(can_be_written(&folder).expect_err("it is one").to_string(), "it is a folder");
        assert_eq!(names(&folder), ["out.json"]);
        std::fs::remove_dir_all(&folder).expect("it can be removed");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn what_a_killed_process_left_is_removed_and_what_others_write_stays() {
        let folder = folder("left");
        // No process has the greatest numbers.
        let old = std::time::SystemTime::now() - 2 * LEFT_FOR;
        for name in [".lightmeter-4294967295-0.part", ".lightmeter-1-0.part", ".lightmeter-x.part"] {
            let file = File::create(folder.join(name)).expect("it can be written");
            file.set_modified(old).expect("it can be set");
        }
        File::create(folder.join(".lightmeter-4294967294-0.part")).expect("it can be written");
        whole(&folder.join("out"), b"").expect("it can be written");
        let mut left = names(&folder);
        left.sort();
        let still = [".lightmeter-1-0.part", ".lightmeter-4294967294-0.part", ".lightmeter-x.part"];
        assert_eq!(left, [&still[..], &["out"]].concat());
        std::fs::remove_dir_all(&folder).expect("it can be removed");
    }

    #[cfg(unix)]
    #[test]
    fn links_devices_and_permissions_stay_what_they_are() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = folder("links");
        let (file, link) = (folder.join("file"), folder.join("link"));
        whole(&file, b"a").expect("it can be written");
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o600)).expect("they can be set");
        symlink(&file, &link).expect("it can be made");
        whole(&link, b"b").expect("it can be written");
        assert!(link.is_symlink() && std::fs::read(&file).expect("it is there") == b"b");
        let mode = std::fs::metadata(&file).expect("it is there").permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
        whole(Path::new("/dev/null"), b"c").expect("it takes all");
        can_be_written(Path::new("/dev/null")).expect("it takes all");
        std::fs::remove_dir_all(&folder).expect("it can be removed");
    }
}
