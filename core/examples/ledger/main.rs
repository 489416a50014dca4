//! Where the energy of a minute's skiing comes from and goes to:
//!
//! ```text
//! cargo run --release -p discjump-core --example ledger [FILE.json]
//! ```
//!
//! prints a Markdown table, and writes its figures to a file where one is named. Means of 16 runs over
//! generated terrain, J/kg. Every term is computed from its own definition, and what they do not explain is
//! shown: it is rounding.
//!
//! ```text
//! run      what is played, in which tiers
//! account  the terms of a tick
//! witness  what a move asked the world, and was answered
//! ```

mod account;
mod run;
mod witness;

use std::fmt::Write;
use std::process::ExitCode;

use account::{TERMS, Term};
use run::{Outcome, Play, STARTS, TICKS, terrain, tiers};

fn main() -> ExitCode {
    let maps = terrain();
    let mut json = Vec::new();
    println!("| run | tier | {} | change | unexplained |", Term::ALL.map(|(_, name)| name).join(" | "));
    println!("|---|---|{}", "---|".repeat(TERMS + 2));
    for (play, name) in Play::ALL {
        for (tier, runs) in tiers(&maps, play) {
            let row = Row::of(&runs);
            println!(
                "| {name} | {tier} | {} | {} | {:.1e} |",
                row.cells(),
                shown(row.change),
                row.unexplained
            );
            json.push(row.json(name, tier));
        }
    }
    let Some(path) = std::env::args().nth(1) else { return ExitCode::SUCCESS };
    let text = format!(
        "{{\n \"seconds\": {},\n \"runs\": {STARTS},\n \"rows\": [\n  {}\n ]\n}}\n",
        f64::from(TICKS) * 0.032,
        json.join(",\n  ")
    );
    match std::fs::write(&path, text) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{path}: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Means over runs, and the largest of what is unexplained.
struct Row {
    terms: [f64; TERMS],
    change: f64,
    unexplained: f64,
}

impl Row {
    fn of(runs: &[Outcome]) -> Self {
        let mean = |of: &dyn Fn(&Outcome) -> f64| runs.iter().map(of).sum::<f64>() / runs.len() as f64;
        Self {
            terms: core::array::from_fn(|k| mean(&|run| run.terms[k])),
            change: mean(&|run| run.ends[1] - run.ends[0]),
            unexplained: runs.iter().map(|run| run.unexplained().abs()).fold(0.0, f64::max),
        }
    }

    fn cells(&self) -> String {
        self.terms.map(shown).join(" | ")
    }

    fn json(&self, play: &str, tier: &str) -> String {
        let mut terms = String::new();
        for ((_, name), joules) in Term::ALL.iter().zip(self.terms) {
            let _ = write!(terms, "\"{name}\": {joules:.6}, ");
        }
        let (change, unexplained) = (self.change, self.unexplained);
        format!(
            "{{\"run\": \"{play}\", \"tier\": \"{tier}\", \"terms\": {{{}}}, \"change\": {change:.6}, \
             \"unexplained\": {unexplained:e}}}",
            terms.trim_end_matches(", ")
        )
    }
}

/// Whole J/kg, and what is less than half of one to one digit.
fn shown(joules: f64) -> String {
    if joules == 0.0 {
        "0".into()
    } else if joules.abs() < 0.5 {
        format!("{joules:.0e}")
    } else {
        format!("{joules:.0}")
    }
}

#[cfg(test)]
mod tests;
