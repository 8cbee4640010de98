//! A channel of a run's tables, read row by row: only the drawn columns are kept in memory.

use super::folders::Run;
use crate::derived::{DERIVED, EXTREMES, is_extreme, is_of_run, lacks};
use crate::{Failure, pictures};
use shearbed_validation::files::csv::Table;
use shearbed_validation::files::output::{RECORD, Sum};
use shearbed_validation::files::text::Shown;
use shearbed_validation::files::{FileError, bounded};
use shearbed_validation::present::plot::Curve;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

/// The largest number of rows of all curves of a picture: a page has some thousand points across, and each row takes
/// some 400 bytes.
pub(super) const MOST_ROWS: usize = 200_000;

/// A channel of a run against time.
pub(super) struct Found {
    pub(super) time: String,
    pub(super) channel: String,
    /// Without a label; without points if the channel is undefined in this run.
    pub(super) curve: Curve,
}

/// The column `wanted` of the run's tables, by default the first of the first table, against the column `across`, by
/// default the time of the run's unit. `left` counts down the rows that may be read.
pub(super) fn channel(
    run: &Run,
    wanted: Option<&str>,
    across: Option<&str>,
    left: &mut usize,
) -> Result<Found, Failure> {
    let mut known = Vec::new();
    let observables = run.scene.output.observables.iter().map(|observable| format!("{}.csv", observable.name()));
    let derived = [EXTREMES, DERIVED].map(str::to_owned).into_iter();
    for name in observables.chain(derived.filter(|name| run.record.files.contains_key(name))) {
        let path = run.dir.join(&name);
        let at = |what: String| Failure::Input(format!("{}{what}", path.shown()));
        let unread = |error: io::Error| at(format!(": cannot be read: {error}"));
        let sum = run.record.files.get(&name);
        let sum = sum.ok_or_else(|| at(format!(": is not listed in the folder's {RECORD}")))?;
        let file = bounded::open(&path).map_err(unread)?;
        let mut table = RunTable::new(&path, file, sum.bytes)?;
        let channels = table.channels();
        let chosen = match wanted {
            Some(wanted) => channels.iter().find(|channel| *channel == wanted),
            None => channels.first(),
        };
        let Some(chosen) = chosen else {
            known.extend(channels);
            continue;
        };
        let time = match across {
            Some(across) => table.0.place(across).ok_or_else(|| at(format!(": has no column {across}")))?,
            None => 0,
        };
        let [x, y, se] = table.columns(time, chosen, left)?;
        run.record.check(&name, &table.sum()).map_err(|why| at(format!(": {why}")))?;
        let half_band = pictures::band(&run.scene, se.into_iter());
        let curve = Curve { x, y, half_band, ..Curve::default() };
        return Ok(Found { time: table.0.names()[time].clone(), channel: chosen.clone(), curve });
    }
    Err(Failure::Input(match wanted {
        Some(wanted) => {
            let why = if is_of_run(wanted) { format!(": {}", lacks(wanted)) } else { String::new() };
            format!("--y {wanted}: {} has no such channel{why}; there are {}", run.dir.shown(), known.join(", "))
        }
        None => format!("{}: no table in it has a column to draw", run.dir.shown()),
    }))
}

/// A table of a run.
struct RunTable(Table<BufReader<Summed>>);

impl RunTable {
    /// Reads the header of a table whose record says that it has `bytes` bytes.
    fn new(path: &Path, file: File, bytes: u64) -> Result<Self, FileError> {
        // One byte more, to detect a longer file.
        let file = file.take(bytes.saturating_add(1));
        let summed = Summed { file, bytes: 0, hasher: crc32fast::Hasher::new() };
        Table::new(path, BufReader::new(summed)).map(Self)
    }

    /// The names of columns with a standard error.
    fn channels(&self) -> Vec<String> {
        // The first column is the time, which has an error too where it is that of an extreme.
        let names = self.0.names().iter().skip(1);
        let channels = names.filter(|name| self.0.place(&format!("{name}_se")).is_some());
        channels.cloned().collect()
    }

    /// The times, from the column at `time`, and the means and standard errors of a channel, each checked. `left`
    /// counts down the rows that may be read.
    fn columns(&mut self, time: usize, channel: &str, left: &mut usize) -> Result<[Vec<f64>; 3], FileError> {
        let place = |name: &str| self.0.place(name).unwrap_or(0);
        let places = [time, place(channel), place(&format!("{channel}_se"))];
        let mut columns = [(); 3].map(|()| Vec::new());
        let mut rows = 0;
        while let Some(row) = self.0.next_row()? {
            rows += 1;
            // A derived value that is undefined.
            if row.cells[places[1]].is_empty() {
                continue;
            }
            let se = if row.cells[places[2]].is_empty() { f64::NAN } else { row.number(places[2])? };
            let [time, mean] = [row.number(places[0])?, row.number(places[1])?];
            let last = columns[0].last().copied();
            if !time.is_finite() || last.is_some_and(|last| time <= last) {
                return Err(row.refused(places[0], "a finite number above that of the row before"));
            }
            if !mean.is_finite() {
                return Err(row.refused(places[1], "a finite number"));
            }
            // For a single rod the standard error is unknown.
            if se.is_infinite() || se < 0.0 {
                return Err(row.refused(places[2], "a finite number ≥ 0, or NaN of a single rod"));
            }
            *left = left.checked_sub(1).ok_or_else(|| {
                row.error(format!(
                    "more than {MOST_ROWS} rows for one picture; fewer runs, or a smaller time.outputs_per_period, are \
                     allowed"
                ))
            })?;
            for (column, value) in columns.iter_mut().zip([time, mean, se]) {
                column.push(value);
            }
        }
        // A run may have no extreme.
        if rows == 0 && !is_extreme(channel) {
            return Err(self.0.error("has a header alone; rows are needed"));
        }
        Ok(columns)
    }

    /// The size and checksum of what was read.
    fn sum(&self) -> Sum {
        let read = self.0.reader().get_ref();
        Sum::from_parts(read.bytes, read.hasher.clone().finalize())
    }
}

/// A reader that computes the checksum of what it reads.
struct Summed {
    file: io::Take<File>,
    bytes: u64,
    hasher: crc32fast::Hasher,
}

impl Read for Summed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(buffer)?;
        self.bytes += read as u64;
        self.hasher.update(&buffer[..read]);
        Ok(read)
    }
}
