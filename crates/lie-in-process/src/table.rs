//! Columns of text.

/// Most characters of a line.
const WIDTH: usize = 100;

/// Rows of cells with columns as wide as their widest cell, aligned to the left. What does not fit into a line stands in
/// further tables below, each with the first column again.
pub fn text(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    let mut used = usize::MAX;
    for (column, width) in widths.iter().enumerate().skip(1) {
        if used.saturating_add(GAP + width) > WIDTH {
            blocks.push(vec![0]);
            used = widths[0];
        }
        used += GAP + width;
        if let Some(block) = blocks.last_mut() {
            block.push(column);
        }
    }
    let blocks = blocks.iter().map(|block| block_text(rows, block, &widths));
    blocks.collect::<Vec<_>>().join("\n")
}

/// Blanks between columns.
const GAP: usize = 2;

fn block_text(rows: &[Vec<String>], columns: &[usize], widths: &[usize]) -> String {
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for column in columns {
            let cell = row.get(*column).map_or("", String::as_str);
            line.push_str(cell);
            line.push_str(&" ".repeat(widths[*column] - cell.chars().count() + GAP));
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(columns: usize) -> Vec<Vec<String>> {
        let row = |row: &str| {
            (0..columns)
                .map(|column| format!("{row}{column:07}"))
                .collect()
        };
        vec![row("a"), row("b")]
    }

    #[test]
    fn what_does_not_fit_stands_below() {
        let one = text(&rows(10));
        assert_eq!(one.lines().count(), 2, "{one}");
        let two = text(&rows(11));
        let lines: Vec<&str> = two.lines().collect();
        assert_eq!(lines.len(), 5, "{two}");
        assert_eq!(lines[0].chars().count(), 98);
        assert_eq!(lines[3], "a0000000  a0000010");
        assert!(
            text(&rows(60))
                .lines()
                .all(|line| line.chars().count() <= WIDTH)
        );
        assert_eq!(text(&[]), "");
    }
}
