//! The words by which this program was started.

use std::ffi::OsString;
use std::sync::OnceLock;

/// Words that replace the process's own if another program contains this one.
struct Words {
    program: Vec<OsString>,
    arguments: Vec<OsString>,
}

static GIVEN: OnceLock<Words> = OnceLock::new();

/// Sets the words `program` that started the program, and its arguments. Only the first call has an effect.
pub(super) fn give(program: Vec<OsString>, arguments: Vec<OsString>) {
    // A second call comes from the same process, and so has the same words.
    let _ = GIVEN.set(Words { program, arguments });
}

/// All words of the command line.
pub(super) fn words() -> Vec<OsString> {
    match GIVEN.get() {
        Some(words) => [&words.program[..], &words.arguments[..]].concat(),
        None => std::env::args_os().collect(),
    }
}

/// The name of the given command, such as `run`; empty if there is none.
pub(super) fn command() -> String {
    let first = |words: &[OsString]| words.first().map(|word| word.to_string_lossy().into_owned());
    let own = || std::env::args_os().skip(1).take(1).collect::<Vec<_>>();
    GIVEN.get().map_or_else(|| first(&own()), |words| first(&words.arguments)).unwrap_or_default()
}

/// The words that start this program again.
pub(super) fn again() -> Vec<OsString> {
    let own = || std::env::current_exe().map_or_else(|_| "shearbed".into(), Into::into);
    GIVEN.get().map_or_else(|| vec![own()], |words| words.program.clone())
}
