//! Pages are never written and executed at once.

use crate::assembler::Pages;

/// The lines of what is mapped into this process.
fn mapped() -> Vec<String> {
    let all = std::fs::read_to_string("/proc/self/maps").unwrap_or_default();
    all.lines().map(str::to_owned).collect()
}

#[test]
fn pages_are_read_and_executed_only() {
    let pages = Pages::new(&[0xC3]).unwrap();
    let place = pages.at(0) as usize;
    let lines = mapped();
    let holds = |line: &&String| {
        let range = line
            .split(' ')
            .next()
            .and_then(|range| range.split_once('-'));
        range.is_some_and(|(from, to)| {
            let [from, to] = [from, to].map(|end| usize::from_str_radix(end, 16).unwrap());
            (from..to).contains(&place)
        })
    };
    // there is a list of what is mapped on Linux alone
    if let Some(line) = lines.iter().find(holds) {
        assert_eq!(line.split(' ').nth(1), Some("r-xp"), "{line}");
    }
    assert!(!lines.iter().any(|line| line.contains(" rwx")), "{lines:?}");
}
