//! The page itself: sections one below the other, nothing from elsewhere.

use std::fmt::Write as _;

/// Text as it stands in HTML, attributes among it.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            _ => out.push(c),
        }
    }
    out
}

/// A page in the making.
#[derive(Default)]
pub struct Page {
    body: String,
}

impl Page {
    /// A headline.
    pub fn section(&mut self, title: &str) {
        let _ = writeln!(self.body, "<h2>{}</h2>", escaped(title));
    }

    /// A paragraph.
    pub fn text(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", escaped(text));
    }

    /// A remark below something.
    pub fn note(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p class=\"note\">{}</p>", escaped(text));
    }

    /// What went wrong.
    pub fn stopped(&mut self, text: &str) {
        let _ = writeln!(
            self.body,
            "<pre class=\"stopped\">{}</pre>",
            escaped(text.trim_end())
        );
    }

    /// A command line.
    pub fn command(&mut self, line: &str) {
        let _ = writeln!(self.body, "<pre class=\"command\">{}</pre>", escaped(line));
    }

    /// Text of fixed width, if there is any.
    pub fn preformatted(&mut self, text: &str) {
        if text.trim().is_empty() {
            return;
        }
        let _ = writeln!(self.body, "<pre>{}</pre>", escaped(text.trim_end()));
    }

    /// Text of fixed width that opens on a click.
    pub fn folded(&mut self, summary: &str, text: &str) {
        let (summary, text) = (escaped(summary), escaped(text.trim_end()));
        let _ = writeln!(
            self.body,
            "<details><summary>{summary}</summary><pre>{text}</pre></details>"
        );
    }

    /// Formulas, which are HTML already.
    pub fn formulas(&mut self, formulas: &[String]) {
        let _ = writeln!(
            self.body,
            "<div class=\"wide\">{}</div>",
            formulas.join("\n")
        );
    }

    /// A picture that was drawn by this command.
    pub fn picture(&mut self, svg: &str) {
        // a page has no place for the declaration of a document
        let start = svg.find("<svg").unwrap_or(0);
        let _ = writeln!(self.body, "<figure>{}</figure>", &svg[start..]);
    }

    /// A scene that turns.
    pub fn scene(&mut self, scene: &serde_json::Value, title: &str) {
        // inside a script nothing but `</` ends it
        let scene = scene.to_string().replace("</", "<\\/");
        let title = escaped(title);
        let _ = writeln!(
            self.body,
            "<canvas id=\"orbit\" tabindex=\"0\" role=\"img\" aria-label=\"{title}\"></canvas>\n\
             <p class=\"note turn\">Drag to turn it, or use the arrow keys; two fingers, or the wheel with Ctrl, change its size.</p>\n\
             <script type=\"application/json\" id=\"scene\">{scene}</script>\n<script>{}</script>",
            include_str!("turn.js")
        );
    }

    /// The whole page; `lead` is HTML.
    pub fn finish(self, title: &str, lead: &str) -> String {
        let title = escaped(title);
        let (style, body) = (include_str!("page.css"), self.body);
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<p class=\"lead\">{lead}</p>\n\
             {body}</body>\n</html>\n"
        )
    }
}
