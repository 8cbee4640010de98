//! `shearbed plot`: one picture of several runs.

use crate::common::{limited, unequal};
use serde_json::{Value, json};

#[test]
fn one_picture_is_drawn_from_several_runs_and_from_a_sweep() {
    let dir = unequal();
    for (seed, out) in [(1, "a"), (2, "b")] {
        dir.runs(&format!("run small.toml --seed {seed} --out {out} --quiet"));
    }
    dir.runs("plot a b --y x2 --out two.svg");
    let picture = dir.read("two.svg");
    for text in [">\na\n<", ">\nb\n<", "95 % band", "t/T"] {
        assert!(picture.contains(text), "{text}");
    }
    // The same picture in pixels: a PNG of the view box's size, that is read back.
    dir.runs("plot a b --y x2 --out two.png");
    let file = std::fs::File::open(dir.at("two.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let (width, height) = reader.info().size();
    assert!(picture.contains(&format!("viewBox=\"0 0 {width} {height}\"")));
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let colours: std::collections::BTreeSet<_> = pixels.chunks(3).collect();
    assert!(colours.len() > 50, "{} colours", colours.len());
    dir.runs("sweep small.toml --over interaction.alpha=0.1,0.2 --quiet --out s");
    dir.runs("plot s --out s.svg");
    assert!(dir.read("s.svg").contains("α = 0.2"));
}

/// The columns of `sweep.csv` as curves, in the order of the values, of which there are more than nine.
#[test]
fn a_sweep_is_drawn_against_its_key() {
    let dir = unequal();
    dir.runs("sweep small.toml --over interaction.alpha=0.1:0.5:5 --over particles.count=20,30 --quiet --out k");
    let plot = "plot k --y x2 --x interaction.alpha --out";
    dir.runs(&format!("{plot} x.svg"));
    let picture = dir.read("x.svg");
    let place = |text: &str| picture.find(text).unwrap_or_else(|| panic!("{text}"));
    // α across, a curve for each count, in the order of the sweep, at the last output.
    assert!(place("N = 20") < place("N = 30"));
    place(">\nα\n<");
    place("A small scene, t/T = ");
    dir.runs(&format!("{plot} first.svg --at 0"));
    assert_ne!(picture, dir.read("first.svg"));
}

/// Synthetic points over a curve, and every flag of the look.
#[test]
fn points_are_drawn_over_curves_and_flags_change_the_look() {
    let dir = unequal();
    dir.runs("run small.toml --quiet --out a");
    dir.write("points.csv", "t_over_T,x1,x1_u\n0.1,0.4,0.05\n0.3,0.2,0.05\n");
    let plot = |arguments: &str| {
        dir.runs(&format!("plot a --y x1 {arguments} --out p.svg --force"));
        dir.read("p.svg")
    };
    let bare = plot("");
    let over = plot("--data points.csv");
    assert!(over.contains("X̄₁, measured ± u") && !bare.contains("measured"));
    let all = plot(
        "--data points.csv --title Damped --x-label turns --y-label share --legend model --legend ours --x-range \
         0.05:0.4 --y-range 0.1:1 --log-y --size 700x500 --theme dark",
    );
    for text in
        [">\nDamped\n<", ">\nturns\n<", ">\nshare\n<", ">\nmodel\n<", ">\nours\n<", "width=\"700\" height=\"500\""]
    {
        assert!(all.contains(text) && !over.contains(text), "{text}");
    }
    assert!(!over.contains("#181818") && all.contains("fill=\"#181818\""));
}

/// Every fault of a table, a record or a folder is refused by name; the same folder before it is drawn.
#[test]
fn what_was_not_written_so_is_not_drawn() {
    let dir = unequal();
    dir.runs("run small.toml --quiet --out a");
    dir.runs("sweep small.toml --over interaction.alpha=0.1:0.7:7 --quiet --out s");
    let table = dir.read("a/projections.csv");
    let cells: Vec<&str> = table.lines().nth(2).unwrap().split(',').collect();
    let row = |cells: &[&str]| table.replace(table.lines().nth(2).unwrap(), &cells.join(","));
    let with = |place: usize, cell: &str| {
        let mut cells = cells.clone();
        cells[place] = cell;
        row(&cells)
    };
    let first = table.lines().next().unwrap();
    let edited = cells[3].replace(|c: char| c.is_ascii_digit(), "1");
    for (text, said) in [
        (with(3, "NaN"), "a/projections.csv:3: column x1: `NaN` is not allowed: expected a finite number"),
        (with(3, "-inf"), "a/projections.csv:3: column x1: `-inf` is not allowed"),
        (with(0, "-1"), "a/projections.csv:3: column t_over_T: `-1` is not allowed"),
        (table.replacen("x2,", "x1,", 1), "a/projections.csv:1: column `x1` is there twice"),
        (format!("{first}\n"), "a/projections.csv:1: has a header alone"),
        (String::new(), "a/projections.csv:1: the file is empty"),
        (with(3, &edited), "a/projections.csv: was changed after it was written"),
    ] {
        dir.write("a/projections.csv", text);
        dir.refuses("plot a --out a.svg", said);
    }
    dir.runs("plot s --out s.svg");
    let point = "s/points/3/projections.csv";
    let whole = dir.read(point);
    let at = whole.rfind(|c: char| c.is_ascii_digit()).unwrap();
    let other = if whole[at..].starts_with('1') { "2" } else { "1" };
    dir.write(point, format!("{}{other}{}", &whole[..at], &whole[at + 1..]));
    dir.refuses("plot s --out t.svg", "s/points/3/projections.csv: was changed");
    std::fs::remove_dir_all(dir.at("s/points/3")).unwrap();
    dir.refuses("plot s --out t.svg", "s/points/3/shearbed.json: cannot be read");
}

/// The record of a file in a `shearbed.json`.
fn sum(text: &str) -> Value {
    json!({ "bytes": text.len(), "crc32": format!("{:08x}", crc32fast::hash(text.as_bytes())) })
}

/// A table of a million rows, with or without a record that has its checksum, is refused in the memory of a small one.
#[test]
fn a_table_too_long_to_draw_is_refused_in_bounded_memory() {
    let dir = unequal();
    dir.runs("run small.toml --quiet --out a");
    // As much as the program itself needs: a short table is drawn.
    let plot = || limited(dir.path(), "ulimit -v 200000", "plot a --out a.svg --force");
    let ended = plot();
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);

    let mut table = dir.read("a/projections.csv").lines().next().unwrap().to_owned() + "\n";
    let cells = ",0.5".repeat(table.split(',').count() - 1);
    table.extend((0..1_000_000).map(|row| format!("{row}{cells}\n")));
    dir.write("a/projections.csv", &table);
    let ended = plot();
    assert!(ended.code == Some(2) && ended.stderr.contains("a/projections.csv"), "{}", ended.stderr);

    let mut record = dir.json("a/shearbed.json");
    record["files"]["projections.csv"] = sum(&table);
    dir.write("a/shearbed.json", record.to_string());
    let ended = plot();
    let said = "a/projections.csv:200002: more than 200000 rows for one picture";
    assert!(ended.code == Some(2) && ended.stderr.contains(said), "{}", ended.stderr);
}

/// The grid, the record and the folders of a sweep must agree.
#[test]
fn a_sweep_is_drawn_with_all_its_points_and_no_other() {
    let dir = unequal();
    dir.runs("sweep small.toml --over interaction.alpha=0.1:0.3:3 --quiet --out s");
    let (record, grid) = (dir.json("s/shearbed.json"), dir.read("s/sweep.json"));
    let edited = |edit: &dyn Fn(&mut Value)| {
        let mut edited = record.clone();
        edit(&mut edited["files"]);
        dir.write("s/shearbed.json", edited.to_string());
    };
    // A point is taken out of the record, or a copy of one is added.
    edited(&|files| drop(files.as_object_mut().unwrap().remove("points/2/shearbed.json")));
    dir.refuses("plot s --x interaction.alpha", "s/shearbed.json: points/2/shearbed.json is not listed");
    for name in ["projections.csv", "shearbed.json"] {
        dir.write(&format!("s/points/4/{name}"), dir.read(&format!("s/points/1/{name}")));
    }
    edited(&|files| files["points/4/shearbed.json"] = files["points/1/shearbed.json"].clone());
    dir.refuses("plot s", "s/shearbed.json: points/4/shearbed.json is listed, and the sweep has 3 points");
    // A point in place of another.
    let [first, second] = ["s/points/1/shearbed.json", "s/points/2/shearbed.json"].map(|name| dir.read(name));
    dir.write("s/points/2/shearbed.json", &first);
    edited(&|files| files["points/2/shearbed.json"] = sum(&first));
    dir.refuses("plot s", "s/points/2/shearbed.json: is of another point");
    dir.write("s/points/2/shearbed.json", second);
    // A grid with one value less, and its checksum.
    let mut less: Value = serde_json::from_str(&grid).unwrap();
    less["over"] = json!([{ "key": "interaction.alpha", "values": [0.1, 0.2] }]);
    dir.write("s/sweep.json", less.to_string());
    edited(&|files| files["sweep.json"] = sum(&less.to_string()));
    dir.refuses("plot s", "s/sweep.json: is of another sweep");
    dir.write("s/sweep.json", grid);
    edited(&|_| ());
    assert_eq!(dir.runs("plot s --x interaction.alpha").stdout, "x1 of 3 points in out/plot.svg\n");
}
