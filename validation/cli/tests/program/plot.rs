//! `shearbed plot`: one picture of several runs.

use crate::common::{limited, unequal};
use serde_json::{Value, json};

/// A PNG of the view box's size, that is read back.
#[test]
fn a_picture_in_pixels_has_the_size_of_its_drawing() {
    let dir = unequal();
    dir.runs("run small.toml --out a --quiet");
    dir.runs("plot a --y x2 --out two.svg");
    dir.runs("plot a --y x2 --out two.png");
    let file = std::fs::File::open(dir.at("two.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let (width, height) = reader.info().size();
    assert!(dir.read("two.svg").contains(&format!("viewBox=\"0 0 {width} {height}\"")));
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let colours: std::collections::BTreeSet<_> = pixels.chunks(3).collect();
    assert!(colours.len() > 50, "{} colours", colours.len());
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
