//! Tables as text, each column as wide as its widest cell.

use comfy_table::{CellAlignment, ContentArrangement, presets};

/// Columns that a table on a terminal may take.
pub const TABLE_WIDTH: usize = 80;

/// On which side the cells of a column begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Words.
    Left,
    /// Numbers.
    Right,
}

/// A table that is being filled: a heading and a side for each column.
#[derive(Clone, Debug)]
pub struct TextTable {
    table: comfy_table::Table,
    sides: Vec<Align>,
}

impl TextTable {
    /// A table of these columns. Where every heading is empty, there is no line of headings.
    #[must_use]
    pub fn new(columns: &[(&str, Align)]) -> Self {
        let mut table = comfy_table::Table::new();
        table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled);
        if columns.iter().any(|(heading, _)| !heading.is_empty()) {
            table.set_header(columns.iter().map(|(heading, _)| *heading));
        }
        Self { table, sides: columns.iter().map(|(_, side)| *side).collect() }
    }

    /// Adds a row.
    pub fn row<T: ToString>(&mut self, cells: impl IntoIterator<Item = T>) {
        self.table.add_row(cells.into_iter().map(|cell| cell.to_string()));
    }

    /// The lines: that of the headings, where there is one, and one for each row.
    #[must_use]
    pub fn lines(mut self) -> Vec<String> {
        for (column, side) in self.table.column_iter_mut().zip(&self.sides) {
            column.set_padding((0, 2));
            column.set_cell_alignment(match side {
                Align::Left => CellAlignment::Left,
                Align::Right => CellAlignment::Right,
            });
        }
        self.table.lines().map(|line| line.trim_end().to_owned()).collect()
    }

    /// The lines as one text, each after `indent`.
    #[must_use]
    pub fn text(self, indent: &str) -> String {
        self.lines().into_iter().map(|line| format!("{indent}{line}\n")).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let mut table = TextTable::new(&[("", Align::Left), ("time", Align::Right), ("what", Align::Left)]);
        table.row(["fog", "1.25 µs", "∞"]);
        table.row(["attenuation", "9 µs", ""]);
        assert_eq!(table.lines(), ["                time  what", "fog          1.25 µs  ∞", "attenuation     9 µs"]);
    }

    #[test]
    fn a_table_without_headings_has_rows_alone() {
        let mut table = TextTable::new(&[("", Align::Left), ("", Align::Right)]);
        table.row([1, 20]);
        table.row([300, 4]);
        assert_eq!(table.text("  "), "  1    20\n  300   4\n");
    }
}
