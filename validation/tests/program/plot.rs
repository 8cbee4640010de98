//! `shearbed plot`: one picture of several runs.

use crate::common::{read, shearbed, unequal};

#[test]
fn one_picture_is_drawn_from_several_runs_and_from_a_sweep() {
    let dir = unequal();
    for (seed, out) in [(1, "a"), (2, "b")] {
        let ended = shearbed(
            dir.path(),
            &format!("run small.toml --seed {seed} --out {out} --quiet"),
        );
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    }
    assert_eq!(
        shearbed(dir.path(), "plot a b --y x2 --out two.svg").code,
        Some(0)
    );
    let picture = read(&dir.path().join("two.svg"));
    for text in [">\na\n<", ">\nb\n<", "95 % band", "t/T"] {
        assert!(picture.contains(text), "{text}");
    }
    // The same picture in pixels: a PNG of the view box's size, that is read back.
    assert_eq!(
        shearbed(dir.path(), "plot a b --y x2 --out two.png").code,
        Some(0)
    );
    let file = std::fs::File::open(dir.path().join("two.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .unwrap();
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
    assert!(
        ended.stderr.contains("no letters for \"ежинрст\""),
        "{}",
        ended.stderr
    );
    let sweep = "sweep small.toml --over interaction.alpha=0.1,0.2 --quiet --out s";
    assert_eq!(shearbed(dir.path(), sweep).code, Some(0));
    assert_eq!(shearbed(dir.path(), "plot s --out s.svg").code, Some(0));
    assert!(read(&dir.path().join("s.svg")).contains("interaction.alpha=0.2"));
    for (arguments, words) in [
        (
            "plot a --y x9",
            "--y x9: a has no such channel; there are x1, x2, x3, x1x2,",
        ),
        (
            "plot nowhere",
            "nowhere: neither run.json nor sweep.json is in it",
        ),
        (
            "plot a --out picture.gif",
            "a name that ends in .svg or .png is allowed",
        ),
    ] {
        let ended = shearbed(dir.path(), arguments);
        assert_eq!(ended.code, Some(2), "{arguments}");
        assert!(ended.stderr.contains(words), "{arguments}: {}", ended.stderr);
    }
    assert!(!dir.path().join("out/plot.svg").exists());
}
