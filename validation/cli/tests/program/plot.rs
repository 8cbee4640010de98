//! `shearbed plot`: one picture of several runs.

use crate::common::bounded::Bounded;
use crate::common::{command, limited, read, shearbed, unequal};
use std::path::Path;

/// Each of these arguments ends with 2 and these words.
fn refused(dir: &Path, all: &[(&str, &str)]) {
    for (arguments, words) in all {
        let ended = shearbed(dir, arguments);
        assert_eq!(ended.code, Some(2), "{arguments}");
        assert!(ended.stderr.contains(words), "{arguments}: {}", ended.stderr);
    }
}

#[test]
fn one_picture_is_drawn_from_several_runs_and_from_a_sweep() {
    let dir = unequal();
    for (seed, out) in [(1, "a"), (2, "b")] {
        let ended = shearbed(dir.path(), &format!("run small.toml --seed {seed} --out {out} --quiet"));
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    }
    assert_eq!(shearbed(dir.path(), "plot a b --y x2 --out two.svg").code, Some(0));
    let picture = read(&dir.path().join("two.svg"));
    for text in [">\na\n<", ">\nb\n<", "95 % band", "t/T"] {
        assert!(picture.contains(text), "{text}");
    }
    // The same picture in pixels: a PNG of the view box's size, that is read back.
    assert_eq!(shearbed(dir.path(), "plot a b --y x2 --out two.png").code, Some(0));
    let file = std::fs::File::open(dir.path().join("two.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let (width, height) = reader.info().size();
    assert!(picture.contains(&format!("viewBox=\"0 0 {width} {height}\"")));
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let colours: std::collections::BTreeSet<_> = pixels.chunks(3).collect();
    assert!(colours.len() > 50, "{} colours", colours.len());
    // Letters that the fonts lack are named, and the picture is made all the same.
    let titled = "run small.toml --set title=\"стержни\" --quiet --out c";
    assert_eq!(shearbed(dir.path(), titled).code, Some(0));
    let ended = shearbed(dir.path(), "plot c --out c.png");
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert!(ended.stderr.contains("no letters for \"ежинрст\""), "{}", ended.stderr);
    let sweep = "sweep small.toml --over interaction.alpha=0.1,0.2 --quiet --out s";
    assert_eq!(shearbed(dir.path(), sweep).code, Some(0));
    assert_eq!(shearbed(dir.path(), "plot s --out s.svg").code, Some(0));
    assert!(read(&dir.path().join("s.svg")).contains("α = 0.2"));
    against_a_swept_key(dir.path());
    refused(
        dir.path(),
        &[
            ("plot a --y x9", "--y x9: a has no such channel; there are x1, x2, x3, x1x2,"),
            ("plot s/points/1", "s/points/1: is one point of a sweep; the sweep's folder is allowed"),
            ("plot nowhere", "nowhere: is no folder of results"),
            ("plot a --x-range 50:70", "--x-range 50:70: nothing lies there; the picture goes from 0 to"),
            ("plot a --y-range 2:3", "--y-range 2:3: nothing lies there; the picture goes from 0."),
            ("plot a --x interaction.alpha", "--x interaction.alpha: a is no sweep"),
            ("plot a s --x interaction.alpha", "2 folders are given; one sweep is allowed"),
            ("plot a --at 1", "--x <KEY>"),
            ("plot a --out picture.gif", "a name that ends in .svg, .png or .pdf is allowed"),
        ],
    );
    assert!(!dir.path().join("out/plot.svg").exists());
}

/// The columns of `sweep.csv` as curves, in the order of the values, of which there are more than nine.
fn against_a_swept_key(dir: &Path) {
    let sweep = "sweep small.toml --over interaction.alpha=0.1:0.5:5 --over particles.count=20,30 --quiet --out k";
    assert_eq!(shearbed(dir, sweep).code, Some(0));
    let plot = |arguments: &str| shearbed(dir, &format!("plot k --y x2 --x interaction.alpha {arguments}"));
    let ended = plot("--out x.svg");
    assert_eq!((ended.code, ended.stdout.as_str()), (Some(0), "x2 of 10 points in x.svg\n"));
    let picture = read(&dir.join("x.svg"));
    let place = |text: &str| picture.find(text).unwrap_or_else(|| panic!("{text}"));
    // α across, a curve for each count, in the order of the sweep, at the last output.
    assert!(place("N = 20") < place("N = 30"));
    place(">\nα\n<");
    place("A small scene, t/T = ");
    // The start is at t = 0, and not to be had on a logarithmic axis.
    let ended = shearbed(dir, "plot k --y x2 --log-x --out log.svg");
    assert!(ended.stderr.contains("--log-x: values at or below 0 are not drawn: 10"), "{}", ended.stderr);
    assert_eq!(plot("--at 0 --out first.svg").code, Some(0));
    assert_ne!(picture, read(&dir.join("first.svg")));
    refused(
        dir,
        &[
            (
                "plot k --x interaction.m",
                "--x interaction.m: the sweep goes over interaction.alpha, particles.count, of",
            ),
            ("plot k --x particles.count --at inf", "'inf' for '--at <TIME>': a finite number"),
            ("plot k --x particles.count --at 1e400", "'1e400' for '--at <TIME>': a finite number"),
            ("plot k --x particles.count --at 1e-12", "--at 0.000000000001: k/points/01 has no output at this time"),
            (
                "plot k --x particles.count --at 77",
                "--at 77: k/points/01 has no output at this time; the nearest is at t/T = ",
            ),
        ],
    );
}

/// Synthetic points over a curve, and every flag of the look.
#[test]
fn points_are_drawn_over_curves_and_flags_change_the_look() {
    let dir = unequal();
    assert_eq!(shearbed(dir.path(), "run small.toml --quiet --out a").code, Some(0));
    let write = |name: &str, text: &str| std::fs::write(dir.path().join(name), text).unwrap();
    write("points.csv", "t_over_T,x1,x1_u\n0.1,0.4,0.05\n0.3,0.2,0.05\n");
    let plot = |arguments: &str| {
        let ended = shearbed(dir.path(), &format!("plot a --y x1 {arguments} --out p.svg --force"));
        assert_eq!(ended.code, Some(0), "{arguments}: {}", ended.stderr);
        read(&dir.path().join("p.svg"))
    };
    write("seconds.csv", "t_s,x1,x1_u\n5,0.4,0.05\n");
    assert_eq!(shearbed(dir.path(), "run small.toml --quiet --out b --set particles.aspect_ratio=9").code, Some(0));
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
    refused(
        dir.path(),
        &[
            ("plot a --data points.csv --y x2", "has no points of x2; it has x1"),
            ("plot a b --y x1 --data seconds.csv", "a point at one t_s stands at different places"),
            ("plot a --legend one --legend two", "given 2 times; the picture has 1"),
            ("plot a --x-range 1:0", "FROM:TO is allowed"),
            ("plot a --log-y --y-range 0:1", "a logarithmic axis begins above 0"),
            ("plot a --size 10x10", "WIDTHxHEIGHT is allowed"),
            ("plot a --theme pink", "[possible values: light, dark]"),
        ],
    );
}

/// Every fault of a table, a record or a folder is refused by name; the same folder before it is drawn.
#[test]
fn what_was_not_written_so_is_not_drawn() {
    let dir = unequal();
    let run = "run small.toml --quiet --out a";
    assert_eq!(shearbed(dir.path(), run).code, Some(0));
    let sweep = "sweep small.toml --over interaction.alpha=0.1:0.7:7 --quiet --out s";
    assert_eq!(shearbed(dir.path(), sweep).code, Some(0));
    let table = read(&dir.path().join("a/projections.csv"));
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
        (with(3, "NaN"), "a/projections.csv:3: x1 = \"NaN\" is not allowed: expected a finite number"),
        (with(3, "-inf"), "a/projections.csv:3: x1 = \"-inf\" is not allowed"),
        (with(0, "-1"), "a/projections.csv:3: t_over_T = \"-1\" is not allowed"),
        (table.replacen("x2,", "x1,", 1), "a/projections.csv:1: column \"x1\" is there twice"),
        (format!("{first}\n"), "a/projections.csv:1: has a header alone"),
        (String::new(), "a/projections.csv:1: is empty"),
        (with(3, &edited), "a/projections.csv: was changed after it was written"),
    ] {
        std::fs::write(dir.path().join("a/projections.csv"), text).unwrap();
        let ended = shearbed(dir.path(), "plot a --out a.svg");
        assert_eq!(ended.code, Some(2), "{said}");
        assert!(ended.stderr.contains(said), "{said}: {}", ended.stderr);
    }
    assert_eq!(shearbed(dir.path(), "plot s --out s.svg").code, Some(0));
    let point = dir.path().join("s/points/3/projections.csv");
    let whole = read(&point);
    let at = whole.rfind(|c: char| c.is_ascii_digit()).unwrap();
    let other = if whole[at..].starts_with('1') { "2" } else { "1" };
    std::fs::write(&point, format!("{}{other}{}", &whole[..at], &whole[at + 1..])).unwrap();
    let ended = shearbed(dir.path(), "plot s --out t.svg");
    assert!(ended.stderr.contains("s/points/3/projections.csv: was changed"), "{}", ended.stderr);
    std::fs::remove_dir_all(dir.path().join("s/points/3")).unwrap();
    let ended = shearbed(dir.path(), "plot s --out t.svg");
    assert!(ended.stderr.contains("s/points/3/shearbed.json: cannot be read"), "{}", ended.stderr);
    assert!(!dir.path().join("t.svg").exists());
}

/// A table of a million rows, with or without a record that has its checksum, is refused in the memory of a small one.
#[test]
fn a_table_too_long_to_draw_is_refused_in_bounded_memory() {
    let dir = unequal();
    let run = "run small.toml --quiet --out a";
    assert_eq!(shearbed(dir.path(), run).code, Some(0));
    let at = |name: &str| dir.path().join("a").join(name);
    // As much as the program itself needs: a short table is drawn.
    let plot = || limited(dir.path(), "ulimit -v 200000", "plot a --out a.svg --force");
    let ended = plot();
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);

    let mut table = read(&at("projections.csv")).lines().next().unwrap().to_owned() + "\n";
    let cells = ",0.5".repeat(table.split(',').count() - 1);
    table.extend((0..1_000_000).map(|row| format!("{row}{cells}\n")));
    std::fs::write(at("projections.csv"), &table).unwrap();
    let ended = plot();
    assert_eq!(ended.code, Some(2), "{}", ended.stderr);
    assert!(ended.stderr.contains("a/projections.csv"), "{}", ended.stderr);

    let mut record: serde_json::Value = serde_json::from_str(&read(&at("shearbed.json"))).unwrap();
    record["files"]["projections.csv"] =
        serde_json::json!({ "bytes": table.len(), "crc32": format!("{:08x}", crc32fast::hash(table.as_bytes())) });
    std::fs::write(at("shearbed.json"), record.to_string()).unwrap();
    let ended = plot();
    assert_eq!(ended.code, Some(2), "{}", ended.stderr);
    let said = "a/projections.csv:200002: more than 200000 rows for one picture";
    assert!(ended.stderr.contains(said), "{}", ended.stderr);
}

/// The grid, the record and the folders of a sweep must agree.
#[test]
fn a_sweep_is_drawn_with_all_its_points_and_no_other() {
    let dir = unequal();
    let sweep = "sweep small.toml --over interaction.alpha=0.1:0.3:3 --quiet --out s";
    assert_eq!(shearbed(dir.path(), sweep).code, Some(0));
    let at = |name: &str| dir.path().join("s").join(name);
    let (record, grid) = (read(&at("shearbed.json")), read(&at("sweep.json")));
    let put = |name: &str, json: &serde_json::Value| std::fs::write(at(name), json.to_string()).unwrap();
    let sum = |text: &str| {
        serde_json::json!({ "bytes": text.len(), "crc32": format!("{:08x}",
        crc32fast::hash(text.as_bytes())) })
    };
    let edited = |edit: &dyn Fn(&mut serde_json::Value)| {
        let mut edited = serde_json::from_str(&record).unwrap();
        edit(&mut edited);
        put("shearbed.json", &edited);
    };
    let files = |json: &mut serde_json::Value| json["files"].as_object_mut().unwrap().clone();
    // A point is taken out of the record, or a copy of one is added.
    edited(&|json| drop(json["files"].as_object_mut().unwrap().remove("points/2/shearbed.json")));
    refused(dir.path(), &[("plot s --x interaction.alpha", "s/shearbed.json: points/2/shearbed.json is not listed")]);
    std::fs::create_dir(at("points/4")).unwrap();
    for name in ["projections.csv", "shearbed.json"] {
        std::fs::copy(at(&format!("points/1/{name}")), at(&format!("points/4/{name}"))).unwrap();
    }
    edited(&|json| json["files"]["points/4/shearbed.json"] = files(json)["points/1/shearbed.json"].clone());
    refused(dir.path(), &[("plot s", "s/shearbed.json: points/4/shearbed.json is listed, and the sweep has 3 points")]);
    // A point in place of another.
    let (first, second) = (read(&at("points/1/shearbed.json")), read(&at("points/2/shearbed.json")));
    std::fs::write(at("points/2/shearbed.json"), &first).unwrap();
    edited(&|json| json["files"]["points/2/shearbed.json"] = sum(&first));
    refused(dir.path(), &[("plot s", "s/points/2/shearbed.json: is of another point")]);
    std::fs::write(at("points/2/shearbed.json"), second).unwrap();
    // A grid with one value less, and its checksum.
    let mut less: serde_json::Value = serde_json::from_str(&grid).unwrap();
    less["over"] = serde_json::json!([{ "key": "interaction.alpha", "values": [0.1, 0.2] }]);
    put("sweep.json", &less);
    edited(&|json| json["files"]["sweep.json"] = sum(&less.to_string()));
    refused(dir.path(), &[("plot s", "s/sweep.json: is of another sweep")]);
    std::fs::write(at("sweep.json"), grid).unwrap();
    std::fs::write(at("shearbed.json"), record).unwrap();
    let ended = shearbed(dir.path(), "plot s --x interaction.alpha");
    assert_eq!((ended.code, ended.stdout.as_str()), (Some(0), "x1 of 3 points in out/plot.svg\n"), "{}", ended.stderr);
}

/// A text that looks like a key and its value is a text.
#[test]
fn no_key_is_read_out_of_a_swept_text() {
    let dir = unequal();
    let ended = command(dir.path(), "sweep small.toml --quiet --out s --over")
        .arg("title='a interaction.alpha=5','b interaction.alpha=7'")
        .ended();
    assert!(ended.status.success());
    refused(
        dir.path(),
        &[
            ("plot s --x interaction.alpha", "--x interaction.alpha: the sweep goes over title, of which one"),
            ("plot s --x title", "--x title: its values are no numbers"),
        ],
    );
}
