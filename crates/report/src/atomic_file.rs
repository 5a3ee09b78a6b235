//! Files that are whole or absent.
//!
//! Content goes to a temporary file in the target's directory, is flushed to the disk and then renamed over
//! the target. A reader, an interruption or a full disk therefore never meets half a file, and an existing
//! file is replaced only by a complete one.

use std::io::{BufWriter, Write};
use std::path::Path;

use crate::ReportError;

/// Writes the file `path` with what `content` puts into the writer, whole or not at all.
///
/// An existing file is replaced. The directory must exist.
///
/// # Errors
/// [`ReportError::Write`] when the system refuses, or whatever error `content` returns; in both cases `path`
/// is as it was before and the temporary file is gone.
pub fn write_atomically<F>(path: &Path, content: F) -> Result<(), ReportError>
where
    F: FnOnce(&mut dyn Write) -> Result<(), ReportError>,
{
    let refused = |source| ReportError::Write {
        path: path.to_path_buf(),
        source,
    };
    let directory = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".slackside-");
    // A temporary file is private by default; a result is an ordinary file, subject to the umask.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let temporary = builder.tempfile_in(directory).map_err(refused)?;

    let mut writer = BufWriter::new(temporary);
    content(&mut writer)?;
    let temporary = writer.into_inner().map_err(|error| refused(error.into_error()))?;
    temporary.as_file().sync_all().map_err(refused)?;
    temporary.persist(path).map_err(|error| refused(error.error))?;
    Ok(())
}

/// Writes the file `path` with the given bytes, whole or not at all; see [`write_atomically`].
///
/// # Errors
/// As [`write_atomically`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
    write_atomically(path, |out| {
        out.write_all(bytes).map_err(|source| ReportError::Write {
            path: path.to_path_buf(),
            source,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_earlier_file_and_no_other() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("rows.csv");
        write_bytes(&path, b"first").unwrap();
        let failed = write_atomically(&path, |out| {
            out.write_all(b"sec").unwrap();
            Err(ReportError::NoColumns { table: "rows".into() })
        });
        assert!(matches!(failed, Err(ReportError::NoColumns { .. })));
        assert_eq!(std::fs::read(&path).unwrap(), b"first");
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_second_write_replaces_the_first() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("rows.csv");
        for text in ["first, longer", "second"] {
            write_bytes(&path, text.as_bytes()).unwrap();
        }
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
    }

    #[test]
    fn a_missing_directory_is_named() {
        let path = Path::new("/nonexistent/directory/rows.csv");
        let error = write_atomically(path, |_| Ok(())).unwrap_err();
        assert!(error.to_string().contains("/nonexistent/directory/rows.csv"));
    }
}
