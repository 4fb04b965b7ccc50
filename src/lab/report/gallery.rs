//! Pictures of one scene: the truth and every run side by side, each also as a picture of its error and of its texels.

use std::io::{self, Cursor, Write};

use base64::display::Base64Display;
use base64::engine::general_purpose::STANDARD;

use super::html::Escaped;
use super::{Cell, Picture, Row, SceneSection};
use crate::encoding::footprint::ANTUMBRA_FOOTPRINT_OCTAVES;
use crate::lab::footprint::colour;

/// Writes the truth and the pictures; nothing when there are none.
pub(super) fn write(sink: &mut impl Write, section: &SceneSection, index: usize, heat_legend: &str) -> io::Result<()> {
    if section.pictures.is_empty() && section.truth_png.is_empty() {
        return Ok(());
    }
    writeln!(sink, "<div class=\"gallery\" data-gallery>\n<div class=\"bar\"><h3>Pictures</h3>")?;
    if section.pictures.iter().any(|picture| !picture.heat_png.is_empty()) {
        write_layers(sink, index)?;
    }
    write_sizes(sink, section, index)?;
    writeln!(sink, "</div>")?;
    if !heat_legend.is_empty() {
        writeln!(sink, "<p class=\"hint\"><b>Error pictures:</b> {}</p>", Escaped(heat_legend))?;
    }
    if section.pictures.iter().any(|picture| !picture.footprint_png.is_empty()) {
        write_scale(sink)?;
    }
    writeln!(sink, "<div class=\"cards\">")?;
    write_truth(sink, section)?;
    for picture in &section.pictures {
        write_card(sink, section, picture)?;
    }
    writeln!(sink, "</div></div>")
}

/// Writes what the colours of the texel pictures mean.
fn write_scale(sink: &mut impl Write) -> io::Result<()> {
    let octaves = ANTUMBRA_FOOTPRINT_OCTAVES as i32;
    let stop = |half: i32| {
        let [r, g, b] = colour(2.0_f64.powf(f64::from(half) / 2.0));
        format!("rgb({r} {g} {b})")
    };
    let stops: Vec<String> = (-2 * octaves..=2 * octaves).map(stop).collect();
    writeln!(
        sink,
        "<div class=\"hint scale\"><p><b>Texel pictures:</b> texels over a pixel, in the direction in which there are \
         fewest. Grey: sky, and what is turned away from the light.</p>\n\
         <div class=\"ramp\"><span>blocks</span><div><i style=\"background:linear-gradient(90deg,{})\"></i><ol>",
        stops.join(",")
    )?;
    for octave in (-octaves..=octaves).step_by(2) {
        let tick = 1_u32 << octave.unsigned_abs();
        writeln!(sink, "<li>{}</li>", if octave < 0 { format!("1/{tick}") } else { tick.to_string() })?;
    }
    writeln!(sink, "</ol></div><span>to spare</span></div></div>")
}

/// Writes the choice between masks, error and texel pictures; it works without the script.
fn write_layers(sink: &mut impl Write, index: usize) -> io::Result<()> {
    writeln!(sink, "<fieldset class=\"choice\"><legend>Show</legend>")?;
    for (value, name) in [("mask", "Shadows"), ("heat", "Error"), ("footprint", "Texels"), ("all", "All")] {
        let checked = if value == "all" { " checked" } else { "" };
        writeln!(
            sink,
            "<label><input type=\"radio\" name=\"layer-{index}\" value=\"{value}\"{checked}><span>{name}</span></label>"
        )?;
    }
    writeln!(sink, "</fieldset>")
}

/// Writes the choice of map size, when there is one; the script fills in what it does.
fn write_sizes(sink: &mut impl Write, section: &SceneSection, index: usize) -> io::Result<()> {
    let mut sizes: Vec<u32> = section.pictures.iter().map(|picture| picture.size).collect();
    sizes.sort_unstable();
    sizes.dedup();
    if sizes.len() < 2 {
        return Ok(());
    }
    writeln!(sink, "<fieldset class=\"choice needs-script\"><legend>Map size</legend>")?;
    for size in sizes {
        writeln!(
            sink,
            "<label><input type=\"radio\" name=\"size-{index}\" value=\"{size}\"><span>{size}</span></label>"
        )?;
    }
    writeln!(
        sink,
        "<label><input type=\"radio\" name=\"size-{index}\" value=\"\" checked><span>All</span></label>\n</fieldset>"
    )
}

/// Writes the card of the truth.
fn write_truth(sink: &mut impl Write, section: &SceneSection) -> io::Result<()> {
    if section.truth_png.is_empty() {
        return Ok(());
    }
    let floor = section.rows.iter().map(|row| row.floor_mae).find(|floor| floor.is_finite());
    let floor = floor.map_or(String::new(), |floor| format!("floor {}", Cell::Difference(floor).text()));
    let alt = format!("Ray-traced shadows of {}, {}", section.scene, section.case);
    writeln!(
        sink,
        "<figure class=\"card truth\" data-name=\"Truth\" data-size=\"\">\n\
         <button type=\"button\" class=\"open\" aria-label=\"Truth at full size\">{}</button>\n\
         <figcaption><span class=\"head\"><b>Truth</b> <span class=\"size\">ray traced</span></span><span class=\"figures\">{floor}</span></figcaption></figure>",
        image(&section.truth_png, "truth", &alt, &section.truth_png)
    )
}

/// Writes the card of one run.
fn write_card(sink: &mut impl Write, section: &SceneSection, picture: &Picture) -> io::Result<()> {
    let Picture { technique, size, png, heat_png, footprint_png, footprint, caption } = picture;
    let row = section.rows.iter().find(|row| row.technique == *technique && row.size == *size);
    let place = format!("{}, {}, {technique} with maps of {size} texels", section.scene, section.case);
    let images = image(png, "mask", &format!("Shadows of {place}"), png)
        + &image(heat_png, "heat", &format!("Error of {place}"), png)
        + &image(footprint_png, "footprint", &format!("Texels over a pixel of {place}"), png);
    writeln!(
        sink,
        "<figure class=\"card\" data-name=\"{name}\" data-size=\"{size}\">\n\
         <button type=\"button\" class=\"open\" aria-label=\"{name} {size} at full size\">{images}</button>\n\
         <figcaption><span class=\"head\"><b>{name}</b> <span class=\"size\">{size}</span>\
         <span class=\"time\">{}</span></span><span class=\"figures\">{}</span><span class=\"caption\">{}</span><span class=\"caption texels\">{}</span></figcaption></figure>",
        row.map(time).unwrap_or_default(),
        row.map(figures).unwrap_or_default(),
        Escaped(caption),
        Escaped(footprint),
        name = Escaped(technique),
    )
}

/// How long a run took, beside its name.
fn time(row: &Row) -> String {
    format!("{} ms", Cell::Milliseconds(row.total_ms).text())
}

/// The errors that stand under a picture.
fn figures(row: &Row) -> String {
    let (mae, wrong) = (Cell::Difference(row.mae).text(), Cell::Share(row.wrong_center).text());
    format!("mae\u{a0}{mae} · wrong\u{a0}{wrong}\u{a0}%")
}

/// A picture inside the page, as large as another one and decoded when it comes into view;
/// an empty one is said to be missing.
fn image(png: &[u8], kind: &str, alt: &str, like: &[u8]) -> String {
    if png.is_empty() {
        let what = match kind {
            "heat" => "error picture",
            "footprint" => "texels",
            _ => "picture",
        };
        return format!("<span class=\"missing {kind}\">no {what}</span>");
    }
    // The size keeps the page from jumping while pictures appear; a PNG without one shows as what it is,
    // a broken picture.
    let size = image::ImageReader::with_format(Cursor::new(like), image::ImageFormat::Png).into_dimensions();
    let size = size.map_or(String::new(), |(width, height)| format!(" width=\"{width}\" height=\"{height}\""));
    format!(
        "<img class=\"{kind}\" src=\"data:image/png;base64,{}\"{size} loading=\"lazy\" decoding=\"async\" alt=\"{}\">",
        Base64Display::new(png, &STANDARD),
        Escaped(alt)
    )
}
