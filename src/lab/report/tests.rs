//! The report as a whole: what is on the page, that it stands alone, and that it appears whole or not at all.

use std::fs;

use super::*;

/// A grey picture whose left part, up to the given share of the width, is in shadow.
fn png(share: f64) -> Vec<u8> {
    let picture =
        image::GrayImage::from_fn(16, 12, |x, _| image::Luma([if f64::from(x) < share * 16.0 { 0 } else { 255 }]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn row(technique: &str, size: u32, mae: f64) -> Row {
    Row {
        scene: "treeline".into(),
        case: "noon".into(),
        technique: technique.into(),
        size,
        mae,
        floor_mae: 0.01,
        wrong_center: mae / 2.0,
        total_ms: f64::from(size) / 500.0,
        left_out: vec![format!("view 1: <{technique}> & no receivers")],
        ..Row::default()
    }
}

fn report() -> Report {
    let failed = Row {
        mae: f64::NAN,
        wrong_center: f64::NAN,
        left_out: vec!["adapter lost <mid-run>".into()],
        ..row("psm", 1024, 0.0)
    };
    let picture = |technique: &str, heat_png: Vec<u8>| Picture {
        technique: technique.into(),
        size: 512,
        png: png(0.4),
        footprint_png: heat_png.clone(),
        heat_png,
        footprint: "texel 1 px <wide>".into(),
        caption: "a \"caption\"".into(),
    };
    Report {
        title: "Compare <all> & more".into(),
        command: "compare --technique \"a,b\"".into(),
        adapter: "llvmpipe".into(),
        notes: vec!["<b>not bold</b>".into()],
        scenes: vec![SceneSection {
            scene: "treeline".into(),
            case: "noon".into(),
            truth_png: png(0.5),
            pictures: vec![picture("ssm", png(0.1)), picture("<script>alert(1)</script>", vec![])],
            rows: vec![
                row("ssm", 512, 0.05),
                row("ssm", 1024, 0.03),
                row("<script>alert(1)</script>", 512, 0.0),
                failed,
            ],
            ..SceneSection::default()
        }],
        ..Report::default()
    }
}

fn page(report: &Report) -> String {
    let mut bytes = Vec::new();
    write_html(&mut bytes, report).unwrap();
    String::from_utf8(bytes).unwrap()
}

#[test]
fn every_row_and_every_line_is_on_the_page() {
    let page = page(&report());
    assert_eq!(page.matches("<th scope=\"row\">").count(), 4);
    assert_eq!(page.matches("<tr class=\"failed\">").count(), 1);
    assert!(page.contains("<q>adapter lost &lt;mid-run&gt;</q>"));
    assert!(page.contains("<q>view 1: &lt;ssm&gt; &amp; no receivers</q> <span class=\"runs\">ssm 512, 1024</span>"));
    assert!(page.contains("data-v=\"NaN\">NaN</td>"));
    assert!(page.contains("<b>1</b> failed run"));
    // The plots say which run they do not show.
    assert!(page.contains("Not drawn, no figure (NaN): ") && page.contains("psm 1024"));
}

#[test]
fn text_from_outside_never_becomes_markup() {
    let page = page(&report());
    assert!(!page.contains("<script>alert") && page.contains("&lt;script&gt;alert(1)"));
    assert!(!page.contains("<b>not bold") && !page.contains("Compare <all>"));
    assert!(page.contains("a &quot;caption&quot;"));
}

#[test]
fn the_page_stands_alone() {
    let page = page(&report());
    for outside in ["http://", "https://", "src=\"//", "@import", "url(", "<link"] {
        assert!(!page.contains(outside), "the page refers to {outside}");
    }
    let sources = page.matches(" src=\"").count();
    assert_eq!(sources, page.matches(" src=\"data:image/png;base64,").count());
    // The truth, two masks, one error and one texel picture; the missing ones are said to be missing.
    assert_eq!(sources, 5);
    assert_eq!(page.matches("loading=\"lazy\"").count(), 5);
    assert!(
        page.contains("width=\"16\" height=\"12\"") && page.contains("no error picture") && page.contains("no texels")
    );
    assert!(
        page.contains("linear-gradient(90deg,rgb(") && page.contains("<li>1/16</li>") && page.contains("&lt;wide&gt;")
    );
}

#[test]
fn every_tag_that_opens_closes() {
    // Read the body as XML once the tags that HTML leaves open are closed.
    let page = page(&report());
    let (_, body) = page.split_once("<body class=\"no-script\">").unwrap();
    let (body, _) = body.split_once("<script>").unwrap();
    let mut xml = String::from("<body>");
    for piece in body.split_inclusive('>') {
        let is_void = ["<img ", "<input "].iter().any(|tag| piece.trim_start().contains(tag));
        xml += &if is_void { piece.replace('>', "/>") } else { piece.to_owned() };
    }
    let xml = xml
        .replace("&ensp;", " ")
        .replace(" checked/", " checked=\"\"/")
        .replace(" data-gallery>", " data-gallery=\"\">")
        .replace(" data-close ", " data-close=\"\" ")
        .replace("class=\"fold\" open>", "class=\"fold\">")
        + "</body>";
    if let Err(error) = roxmltree::Document::parse(&xml) {
        let line = xml.lines().nth(error.pos().row as usize - 1).unwrap_or_default();
        panic!("{error}: {}", line.chars().take(300).collect::<String>());
    }
}

#[test]
fn a_report_of_nothing_is_still_a_page() {
    let empty = Report { scenes: vec![SceneSection::default()], ..Report::default() };
    let page = page(&empty);
    assert!(
        page.contains("No run, no figures.") && page.contains("No run was measured") && page.ends_with("</html>\n")
    );
}

#[test]
fn a_report_takes_the_place_of_an_older_one_and_leaves_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("deep/down");
    write_report(&dir, &Report::default()).unwrap();
    write_report(&dir, &report()).unwrap();
    let mut names: Vec<_> = fs::read_dir(&dir).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, [INDEX_FILE, RESULTS_FILE]);
    assert_eq!(read_csv(&dir.join(RESULTS_FILE)).unwrap().len(), 4);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = fs::metadata(dir.join(INDEX_FILE)).unwrap().permissions().mode();
        assert_eq!(mode & 0o400, 0o400, "owner cannot read");
        let plain = dir.join("plain");
        fs::write(&plain, "").unwrap();
        assert_eq!(mode, fs::metadata(plain).unwrap().permissions().mode(), "rights of an ordinary file");
    }
}

#[test]
fn a_place_that_cannot_be_written_is_named_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a-file");
    fs::write(&file, "precious").unwrap();
    // A file where the folder should be, and a file on the way to it.
    for dir in [file.clone(), file.join("below")] {
        let error = write_report(&dir, &report()).unwrap_err().to_string();
        assert!(error.contains("a-file") && error.contains("name a ") && !error.contains('\n'), "{error}");
    }
    assert_eq!(fs::read_to_string(&file).unwrap(), "precious");
    // A folder where the page should be: the table must not appear without its page.
    let dir = folder.path().join("out");
    fs::create_dir_all(dir.join(INDEX_FILE)).unwrap();
    let error = write_report(&dir, &report()).unwrap_err().to_string();
    assert!(error.contains("index.html is a folder"), "{error}");
    assert_eq!(fs::read_dir(&dir).unwrap().count(), 1, "half a report was left behind");
}
