//! Columns of text.

/// Rows of cells with columns as wide as their widest cell; the first is aligned to the left, the others too unless
/// they look like numbers.
pub fn text(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (index, cell) in row.iter().enumerate() {
            let pad = " ".repeat(widths[index] - cell.chars().count());
            line.push_str(cell);
            line.push_str(&pad);
            line.push_str("  ");
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// A number in few characters: `3.1e-15`, `0`, `2.98`.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if value.is_infinite() {
        "∞".to_owned()
    } else if value.is_nan() {
        "none".to_owned()
    } else if value.fract() == 0.0 && value.abs() < 1e6 {
        format!("{value}")
    } else if (0.01..100.0).contains(&value.abs()) {
        format!("{value:.2}")
    } else {
        format!("{value:.1e}")
    }
}
