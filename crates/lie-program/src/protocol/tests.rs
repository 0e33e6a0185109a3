use super::*;

fn run(times: Times) -> Run {
    Run {
        method: "dopri5".to_owned(),
        start: Start {
            parameters: [("k".to_owned(), 1e-300)].into(),
            initial: vec![-0.5, 0.1 + 0.2],
        },
        pace: Pace::Step(0.1),
        from: 0.5,
        times,
        tolerances: Tolerances::both(1e-8),
        newton: NewtonOptions::fixed_point(),
        keep: Keep::ENERGY,
        density: Density::Reversible,
        assess: 0,
        element: vec![0.1 + 0.2, 1e-300],
        from_milestone: None,
        milestones: Milestones::Every(5000),
        curve: true,
        held: Default::default(),
        sources: Default::default(),
    }
}

#[test]
fn a_request_comes_back_and_has_an_end() {
    let until = Times::Until {
        end: -2.0,
        every: 5,
    };
    let within = Times::Within {
        end: 4.0,
        times: vec![1.5, 0.25],
    };
    for (times, end, save) in [
        (until, -2.0, Save::Every(5)),
        (Times::At(vec![1.5, 0.25]), 1.5, Save::At(vec![1.5, 0.25])),
        (within, 4.0, Save::At(vec![1.5, 0.25])),
    ] {
        let run = run(times);
        let line = serde_json::to_string(&run).expect("text");
        assert_eq!(serde_json::from_str::<Run>(&line).expect("a run"), run);
        assert!(!line.contains('\n'), "one line");
        assert_eq!((run.span(), run.options().save), ((0.5, end), save));
        assert_eq!(run.options().newton, NewtonOptions::fixed_point());
    }
}

#[test]
fn what_is_not_known_is_refused() {
    let line = serde_json::to_string(&run(Times::At(vec![]))).expect("text");
    for (known, wrong) in [
        ("\"step\":0.1", "\"step\":\"x\""),
        ("\"pace\":{\"step\":0.1},", ""),
        ("{\"step\":0.1}", "{\"speed\":3}"),
        ("\"step\":0.1", "\"step\":0.1,\"speed\":3"),
        ("fixed-point", "secant"),
    ] {
        let spoiled = line.replace(known, wrong);
        assert_ne!(line, spoiled, "{known}");
        assert!(serde_json::from_str::<Run>(&spoiled).is_err(), "{spoiled}");
    }
}

#[test]
fn columns_have_their_places() {
    let names = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
    let columns = Columns {
        coordinates: Coordinates::Named(names("x y z")),
        casimirs: names("C D"),
        quantities: names("work"),
        element: 9,
    };
    assert_eq!((columns.energy(), columns.casimirs()), (4, 5));
    assert_eq!((columns.quantities(), columns.element()), (7, 8));
    assert_eq!(columns.width(), 17);
    let of_sites = Columns {
        coordinates: Coordinates::OfSites(3),
        ..columns.clone()
    };
    assert_eq!((of_sites.energy(), of_sites.width()), (4, 17));
}
