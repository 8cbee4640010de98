//! The inputs of a grading: references and answers by their checksums, and the options for reading them.

use super::Args;
use crate::Failure;
use serde_json::{Value, json};
use shearbed_validation::files::{FileError, bounded};
use shearbed_validation::serve::grade::live::Protocol;
use shearbed_validation::serve::problems::LoadedProblem;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The largest file of an answer, in bytes.
const MOST_BYTES: u64 = 1 << 36;

/// The input of a grading of files.
pub(super) fn of_files(args: &Args, reference: &Path, mine: &Path, wanted: &[LoadedProblem]) -> Result<Value, Failure> {
    let mut inputs = of_program(args, Some(reference), wanted)?;
    inputs["answers_crc32"] = json!(checksums(mine, wanted)?);
    Ok(inputs)
}

/// The input of a grading of a program, whose answers may differ from one run to the next.
pub(super) fn of_program(args: &Args, reference: Option<&Path>, wanted: &[LoadedProblem]) -> Result<Value, Failure> {
    let reference = reference.map(|dir| checksums(dir, wanted)).transpose()?;
    let problems: Vec<_> = wanted.iter().map(|loaded| &loaded.problem.name).collect();
    Ok(json!({
        "problems": problems,
        "reference_crc32": reference,
        // A list of several programs.
        "command": if args.command.len() > 1 { json!(args.command) } else { json!(args.command.first()) },
        "protocol": args.protocol.map(Protocol::word),
        "flow": args.flow,
        "tolerances": wanted.iter().map(|loaded| loaded.problem.tolerance).collect::<Vec<_>>(),
        "timeout": args.timeout,
        "brief": args.brief,
        "all": args.all,
        "columns": args.columns,
        "layout": args.layout,
        "axes": args.axes.to_string(),
        "windows_text": args.windows_text,
        "timestep_s": args.timestep_s,
        "rod_axis": args.rod_axis,
        "order": args.order,
    }))
}

/// The checksums of the files in each problem's folder inside `dir`, by `NAME/FILE`.
fn checksums(dir: &Path, wanted: &[LoadedProblem]) -> Result<BTreeMap<String, String>, Failure> {
    let mut sums = BTreeMap::new();
    for name in wanted.iter().map(|loaded| &loaded.problem.name) {
        // Without a folder no file was read for this problem.
        for entry in fs::read_dir(dir.join(name)).into_iter().flatten().flatten() {
            let path = entry.path();
            if !path.is_file() {
                continue;
            }
            let sum = bounded::length_and_crc32(&path, MOST_BYTES);
            let (_, crc32) = sum.map_err(|error| FileError::unreadable(&path, &error))?;
            let file = format!("{name}/{}", entry.file_name().to_string_lossy());
            sums.insert(file, format!("{crc32:08x}"));
        }
    }
    Ok(sums)
}
