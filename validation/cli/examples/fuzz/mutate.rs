//! Inputs from a small corpus: bytes, numbers, words and lines of one file put wrong, or exchanged with those of
//! another.

use crate::Set;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;

/// Numbers and words at which readers break, separated by `|`.
const HOSTILE: &str = "0|-0|1|-1|2|0.5|1e-9|1e-8|1e8|1e300|1e308|1e309|-1e308|5e-324|1e-400|nan|NaN|inf|-inf|+inf\
    |1.0000000000000002|9007199254740993|9223372036854775807|9223372036854775808|18446744073709551616\
    |-9223372036854775808|1_000|0x10|0b1|1e|.5|5.|--1|true|\"\"|\"x\"|[]|[[]]|{}|{ a = 1 }|[1, 2|'|\"|\\|#|=|,\
    |,,|:|1979-05-27|\u{0}|\u{1b}[2J|\u{202e}|\u{feff}|é|１|100000000|1:2:100001";

/// A source of inputs.
pub struct Mutator(Pcg64Dxsm);

impl Mutator {
    /// The inputs of a seed.
    pub fn new(seed: u64) -> Self {
        Self(Pcg64Dxsm::seed_from_u64(seed))
    }

    /// A set of the corpus with one to four changes.
    pub fn of(&mut self, corpus: &[Set]) -> Set {
        let mut files = corpus[self.below(corpus.len())].clone();
        for _ in 0..1 + self.below(4) {
            let at = self.below(files.len());
            let other = &corpus[self.below(corpus.len())];
            let other = &other[at.min(other.len() - 1)].1;
            self.change(&mut files[at].1, other);
        }
        files
    }

    fn below(&mut self, count: usize) -> usize {
        self.0.random_range(0..count.max(1))
    }

    fn hostile(&mut self) -> &'static str {
        let all: Vec<_> = HOSTILE.split('|').collect();
        all[self.below(all.len())]
    }

    fn change(&mut self, bytes: &mut Vec<u8>, other: &[u8]) {
        match self.below(12) {
            0 => {
                let at = self.below(bytes.len());
                if let Some(byte) = bytes.get_mut(at) {
                    *byte ^= 1 << self.0.random_range(0..8);
                }
            }
            1 => {
                let at = self.below(bytes.len() + 1);
                bytes.insert(at, self.0.next_u32() as u8);
            }
            2 => bytes.truncate(self.below(bytes.len() + 1)),
            3 => {
                let (from, to) = self.part(bytes);
                bytes.drain(from..to);
            }
            4 => {
                let word = self.hostile();
                let at = self.below(bytes.len() + 1);
                bytes.splice(at..at, word.bytes());
            }
            5 => {
                // Deep, or long.
                let word = ["[", "{", "a.", "9", "\"", "\n", "é", "1,"][self.below(8)];
                let many = word.repeat(1 << self.below(14));
                let at = self.below(bytes.len() + 1);
                bytes.splice(at..at, many.bytes());
            }
            6 | 7 => self.lines(bytes, other),
            _ => {
                // A number or word of the text in place of which another one stands.
                let tokens = tokens(bytes);
                let others = self::tokens(other);
                if tokens.is_empty() {
                    return;
                }
                let (from, to) = tokens[self.below(tokens.len())];
                let new = match (self.below(4), others.is_empty()) {
                    (0, false) => {
                        let (from, to) = others[self.below(others.len())];
                        other[from..to].to_vec()
                    }
                    (1, _) => self.number(),
                    _ => self.hostile().as_bytes().to_vec(),
                };
                bytes.splice(from..to, new);
            }
        }
    }

    /// A number of any size.
    fn number(&mut self) -> Vec<u8> {
        match self.below(4) {
            0 => format!("{}", self.0.random_range(-9_i64..200)),
            1 => format!("{:e}", f64::from_bits(self.0.next_u64())),
            2 => format!("{}", self.0.random::<f64>() * 10_f64.powi(self.0.random_range(-12..12))),
            _ => format!("{}", self.0.next_u64()),
        }
        .into_bytes()
    }

    fn part(&mut self, bytes: &[u8]) -> (usize, usize) {
        let from = self.below(bytes.len());
        (from, (from + 1 + self.below(16)).min(bytes.len()))
    }

    /// A line goes, comes twice, moves, or comes from the other text.
    fn lines(&mut self, bytes: &mut Vec<u8>, other: &[u8]) {
        let split =
            |bytes: &[u8]| -> Vec<Vec<u8>> { bytes.split_inclusive(|b| *b == b'\n').map(<[u8]>::to_vec).collect() };
        let (mut lines, others) = (split(bytes), split(other));
        if lines.is_empty() || others.is_empty() {
            return;
        }
        let (at, to) = (self.below(lines.len()), self.below(lines.len()));
        match self.below(4) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(to, lines[at].clone()),
            2 => lines.swap(at, to),
            _ => lines.insert(to, others[self.below(others.len())].clone()),
        }
        *bytes = lines.concat();
    }
}

/// Where numbers and words of a text are.
fn tokens(bytes: &[u8]) -> Vec<(usize, usize)> {
    let word = |byte: &u8| byte.is_ascii_alphanumeric() || b"._+-".contains(byte);
    let mut to = 0;
    let runs = bytes.chunk_by(|a, b| word(a) == word(b)).map(|run| {
        to += run.len();
        (word(&run[0]), (to - run.len(), to))
    });
    runs.filter(|(is_word, _)| *is_word).map(|(_, place)| place).collect()
}
