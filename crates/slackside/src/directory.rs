//! A directory of results: written beside its place and moved there as a whole.

use crate::failure::Failure;
use std::path::{Path, PathBuf};

/// The file that every directory of results holds.
pub const RESULT: &str = "result.json";

/// Makes a directory of results with `fill` and puts it in place of `target`; an earlier result there is replaced only
/// when the new one is complete.
///
/// # Errors
/// [`Failure::ForeignDirectory`] if something else than a result is in the way; what `fill` reports; [`Failure::Write`].
pub fn replace(target: &Path, fill: &dyn Fn(&Path) -> Result<(), Failure>) -> Result<(), Failure> {
    let fault = |path: &Path| {
        let path = path.to_owned();
        move |source| Failure::Write { path, source }
    };
    if target.exists() && !is_replaceable(target) {
        return Err(Failure::ForeignDirectory(target.to_owned()));
    }
    let parent = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    };
    std::fs::create_dir_all(&parent).map_err(fault(&parent))?;
    // Dropped on any failure, which removes it.
    let fresh = tempfile::Builder::new()
        .prefix(".slackside-")
        .tempdir_in(&parent)
        .map_err(fault(&parent))?;
    fill(fresh.path())?;
    open_to_others(fresh.path());
    if target.exists() {
        let old = tempfile::Builder::new()
            .prefix(".slackside-old-")
            .tempdir_in(&parent)
            .map_err(fault(&parent))?;
        let aside = old.path().join("result");
        std::fs::rename(target, &aside).map_err(fault(target))?;
        if let Err(source) = std::fs::rename(fresh.path(), target) {
            // The earlier result goes back to its place.
            let _ = std::fs::rename(&aside, target);
            return Err(fault(target)(source));
        }
    } else {
        std::fs::rename(fresh.path(), target).map_err(fault(target))?;
    }
    // The directory has moved: there is nothing left to remove.
    let _ = fresh.keep();
    Ok(())
}

/// An empty directory, or one with a result.
fn is_replaceable(target: &Path) -> bool {
    let is_empty = std::fs::read_dir(target).is_ok_and(|mut entries| entries.next().is_none());
    target.is_dir() && (is_empty || target.join(RESULT).is_file())
}

/// Temporary directories are closed to other users; results are not.
#[cfg(unix)]
fn open_to_others(path: &Path) {
    use std::os::unix::fs::PermissionsExt;
    // Without the right the result is still there for its owner.
    let _ = std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755));
}

#[cfg(not(unix))]
fn open_to_others(_: &Path) {}
