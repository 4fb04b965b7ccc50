//! The page: one HTML file with its pictures, plots, style and script inside, so that it opens anywhere, offline.

use std::fmt;
use std::io::{self, Write};
use std::time::Duration;

use super::column::{COLUMNS, Column};
use super::{Report, SceneSection, curves, gallery, overview, table};

/// Text made safe for HTML and SVG, between tags and inside double quotes.
pub(super) struct Escaped<'a>(pub(super) &'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in self.0.chars() {
            match c {
                '&' => f.write_str("&amp;")?,
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '"' => f.write_str("&quot;")?,
                '\'' => f.write_str("&#39;")?,
                // Neither HTML nor XML has a place for other control characters.
                c if c.is_control() && !matches!(c, '\n' | '\t') => f.write_str("\u{fffd}")?,
                c => write!(f, "{c}")?,
            }
        }
        Ok(())
    }
}

/// Writes the page to a sink; wrap a file in a `BufWriter`.
///
/// # Errors
/// Those of the sink.
pub fn write_html(sink: &mut impl Write, report: &Report) -> io::Result<()> {
    write_head(sink, report)?;
    write_masthead(sink, report)?;
    writeln!(sink, "<main>")?;
    overview::write(sink, report)?;
    let styles = curves::technique_order(report);
    for (index, section) in report.scenes.iter().enumerate() {
        write_section(sink, report, section, index, &styles)?;
    }
    write_guide(sink)?;
    writeln!(sink, "</main>")?;
    write_foot(sink)
}

/// Writes everything before the body.
fn write_head(sink: &mut impl Write, report: &Report) -> io::Result<()> {
    write!(
        sink,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n<style>\n{}</style>\n</head>\n<body class=\"no-script\">\n\
         <a class=\"skip\" href=\"#summary\">Skip to the summary</a>\n",
        Escaped(&report.title),
        include_str!("page.css"),
    )
}

/// Writes the headline and what was run, on what.
fn write_masthead(sink: &mut impl Write, report: &Report) -> io::Result<()> {
    writeln!(sink, "<header class=\"masthead\">\n<div class=\"eclipse\" aria-hidden=\"true\"></div>")?;
    writeln!(sink, "<h1>{}</h1>\n<dl class=\"facts\">", Escaped(&report.title))?;
    let took = duration(report.duration);
    for (term, value) in
        [("Adapter", &report.adapter), ("Commit", &report.commit), ("Started", &report.started), ("Took", &took)]
    {
        let value = if value.is_empty() { "not stated" } else { value };
        writeln!(sink, "<div><dt>{term}</dt><dd>{}</dd></div>", Escaped(value))?;
    }
    writeln!(sink, "</dl>")?;
    if !report.command.is_empty() {
        writeln!(sink, "<pre class=\"command\" tabindex=\"0\"><code>{}</code></pre>", Escaped(&report.command))?;
    }
    // Offer a way to each scene, and to the guide at the end.
    writeln!(sink, "<nav aria-label=\"Contents\"><ul>")?;
    for (index, section) in report.scenes.iter().enumerate() {
        writeln!(
            sink,
            "<li><a href=\"#scene-{index}\">{} <span>{}</span></a></li>",
            Escaped(&section.scene),
            Escaped(&section.case)
        )?;
    }
    writeln!(
        sink,
        "<li><a href=\"#guide\">How to read this</a></li>\n<li><a href=\"#bias\">Bias</a></li></ul></nav>\n</header>"
    )
}

/// Writes one case of one scene.
fn write_section(
    sink: &mut impl Write,
    report: &Report,
    section: &SceneSection,
    index: usize,
    styles: &[&str],
) -> io::Result<()> {
    writeln!(
        sink,
        "<section class=\"scene\" id=\"scene-{index}\" aria-labelledby=\"scene-{index}-title\">\n\
         <h2 id=\"scene-{index}-title\">{} <span class=\"case\">{}</span></h2>",
        Escaped(&section.scene),
        Escaped(&section.case)
    )?;
    if !section.description.is_empty() {
        writeln!(sink, "<p class=\"lead\">{}</p>", Escaped(&section.description))?;
    }
    gallery::write(sink, section, index, &report.heat_legend)?;
    curves::write(sink, section, styles)?;
    table::write_left_out(sink, section)?;
    table::write(sink, section)?;
    writeln!(sink, "</section>")
}

/// Writes how to read the page and what it does not say.
fn write_guide(sink: &mut impl Write) -> io::Result<()> {
    sink.write_all(include_str!("guide.html").as_bytes())?;
    writeln!(sink, "<section class=\"prose\" id=\"columns\"><h2>What the columns mean</h2>\n<dl class=\"glossary\">")?;
    for Column { name, heading, unit, meaning, .. } in &COLUMNS {
        let unit = if unit.is_empty() { String::new() } else { format!(" <small>{unit}</small>") };
        writeln!(sink, "<div><dt>{heading}{unit} <code>{name}</code></dt><dd>{meaning}</dd></div>")?;
    }
    writeln!(sink, "</dl></section>")
}

/// Writes the dialog that shows pictures at full size, the script, and the end.
fn write_foot(sink: &mut impl Write) -> io::Result<()> {
    sink.write_all(include_str!("lightbox.html").as_bytes())?;
    let version = env!("CARGO_PKG_VERSION");
    writeln!(
        sink,
        "<footer>Made by antumbra {version}. The figures are in <code>{}</code> beside this page.</footer>",
        super::RESULTS_FILE
    )?;
    writeln!(sink, "<script>\n{}</script>", include_str!("page.js"))?;
    writeln!(sink, "</body>\n</html>")
}

/// Writes a duration with the two units that matter.
fn duration(duration: Duration) -> String {
    let seconds = duration.as_secs();
    match seconds {
        0..10 => format!("{:.1} s", duration.as_secs_f64()),
        10..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        _ => format!("{} h {} min", seconds / 3600, seconds / 60 % 60),
    }
}
