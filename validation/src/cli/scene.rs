//! Finding the scene that the command line names.

use super::Failure;
use crate::start::Starts;
use crate::sweep::{self, Setting};
use crate::text::line;
use crate::{cluster, scenes};
use shearbed::{Scene, scene_file};
use std::ffi::OsStr;
use std::io::Write;
use std::path::Path;

/// A scene with the name of what is made from it.
pub(super) struct Named {
    pub(super) scene: Scene,
    /// The text it was read from.
    pub(super) text: String,
    /// The file as given, or the built-in scene's name: for messages.
    pub(super) source: String,
    /// What was read of files of starts beside it.
    pub(super) starts: Starts,
    /// The stem of the file's name, or the built-in scene's name.
    pub(super) stem: String,
}

impl Named {
    /// The same with some keys set.
    pub(super) fn with(mut self, settings: &[Setting]) -> Result<Self, Failure> {
        if settings.is_empty() {
            return Ok(self);
        }
        for (k, Setting { key, .. }) in settings.iter().enumerate() {
            if settings[..k].iter().any(|other| other.key == *key) {
                return Err(Failure::Input(format!(
                    "--set {key}: given twice; each key once is allowed"
                )));
            }
        }
        self.scene = sweep::scene_with(&self.text, settings).map_err(|error| {
            let said = settings
                .iter()
                .map(|setting| format!(" --set {}={}", setting.key, sweep::shown(&setting.value)));
            Failure::Input(format!("{}{}: {error}", self.source, said.collect::<String>()))
        })?;
        self.starts
            .fill(&mut self.scene)
            .map_err(|error| refused(&self.source, &error))?;
        Ok(self)
    }
}

fn refused(source: &str, error: &str) -> Failure {
    Failure::Input(format!("{source}: {error}"))
}

/// Reads the file `given`, or where there is none the built-in scene of that name.
pub(super) fn load(given: &OsStr) -> Result<Named, Failure> {
    let path = Path::new(given);
    let source = path.display().to_string();
    let built_in = scenes::find(&source).filter(|_| !path.exists() || path.is_dir());
    if let Some(built_in) = built_in {
        let scene = built_in
            .scene()
            .map_err(|error| Failure::Input(error.to_string()))?;
        let stem = source.clone();
        let text = built_in.text.to_owned();
        return Ok(Named {
            scene,
            text,
            source,
            starts: Starts::default(),
            stem,
        });
    }
    let text = read(path)?;
    let mut scene = scene_file::parse(&source, &text).map_err(|error| Failure::Input(error.to_string()))?;
    let mut starts = Starts::beside(path.parent().unwrap_or(Path::new("")));
    starts
        .fill(&mut scene)
        .map_err(|error| refused(&source, &error))?;
    let stem = path.file_stem().unwrap_or(given).to_string_lossy().into_owned();
    Ok(Named {
        scene,
        text,
        source,
        starts,
        stem,
    })
}

/// Says on standard error, from the root, what the reader of the results should know before trusting them.
pub(super) fn warn<'a>(source: &str, warnings: impl IntoIterator<Item = &'a String>) {
    if !cluster::is_root() {
        return;
    }
    let mut stderr = std::io::stderr().lock();
    for warning in warnings {
        // A warning that cannot be written stands in the files all the same.
        let _ = writeln!(stderr, "{}", line(&format!("warning: {source}: {warning}")));
    }
}

fn read(path: &Path) -> Result<String, Failure> {
    let source = path.display();
    let bytes = std::fs::read(path).map_err(|error| {
        let known = if path.exists() {
            String::new()
        } else {
            built_in_names(&source.to_string())
        };
        Failure::Input(format!("{source}: cannot be read: {error}{known}"))
    })?;
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        Failure::Input(format!(
            "{source}:{line}: not a text in UTF-8, as a scene file must be"
        ))
    })
}

fn built_in_names(name: &str) -> String {
    let close = scenes::close_to(name);
    let close = match close.is_empty() {
        true => String::new(),
        false => format!(" (close names: {})", close.join(", ")),
    };
    format!("; nor is it a built-in scene{close}: `shearbed scenes` lists them")
}
