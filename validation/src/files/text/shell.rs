//! Command lines that a shell splits into the same words.

use super::commands;
use std::ffi::OsStr;

/// A command line that a POSIX shell splits into these words; a word that is not valid text is quoted in the form of
/// bash and zsh.
pub fn command<W: AsRef<OsStr>>(words: impl IntoIterator<Item = W>) -> String {
    let words: Vec<_> = words.into_iter().map(|word| quoted(word.as_ref())).collect();
    words.join(" ")
}

fn quoted(word: &OsStr) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./,:=+@%".contains(c);
    match word.to_str() {
        Some(text) if !text.is_empty() && text.chars().all(plain) => text.to_owned(),
        Some(text) if !text.contains(|c| c == '\n' || c == '\t' || commands(c)) => {
            format!("'{}'", text.replace('\'', r"'\''"))
        }
        _ => {
            let bytes = word.as_encoded_bytes().iter();
            let written = bytes.map(|byte| match byte {
                b'\'' | b'\\' => format!("\\{}", char::from(*byte)),
                b' '..=b'~' => char::from(*byte).to_string(),
                _ => format!("\\x{byte:02x}"),
            });
            format!("$'{}'", written.collect::<String>())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The words into which bash splits the command line.
    #[cfg(unix)]
    #[test]
    fn a_shell_reads_the_same_words() {
        use std::os::unix::ffi::OsStrExt;
        let words: [&[u8]; 10] = [
            b"plain-1.0/x=y",
            b"",
            b"two words",
            b"it's $HOME `date` \"q\" \\ !",
            b"*?[a]{b}~;&|<>()#",
            b"\x1b]0;x\x07",
            b"not \xff\xfe text'\\",
            b"a\nb",
            b"a\tb",
            "α=½".as_bytes(),
        ];
        let line = command(words.iter().map(|word| OsStr::from_bytes(word)));
        let script = format!("printf '%s\\0' {line}");
        let output = std::process::Command::new("bash").args(["-c", &script]).output().unwrap();
        let found: Vec<_> = output.stdout.split(|byte| *byte == 0).collect();
        assert_eq!(found[..words.len()], words);
        assert!(!line.contains(['\u{1b}', '\n', '\t']));
    }
}
