//! Whether the accounts close, and say what they must.

use super::account::Term;
use super::run::{Outcome, Play, TICKS, terrain, tiers};

/// Rounding of one tick's account, in units of the last place of the largest energy of the run: half of one for
/// the new energy itself, and as much for what a few sums of the tick are off by.
const ULPS_PER_TICK: f64 = 2.0;

fn all(play: Play) -> [(&'static str, Vec<Outcome>); 4] {
    tiers(&terrain(), play)
}

fn of(run: &Outcome, term: Term) -> f64 {
    run.terms[term as usize]
}

/// The largest energy on the way, J/kg: what goes through the account in all bounds it.
fn largest(run: &Outcome) -> f64 {
    run.ends[0].abs() + run.terms.iter().filter(|term| **term > 0.0).sum::<f64>()
}

#[test]
fn every_account_closes_to_rounding() {
    for (play, name) in Play::ALL {
        for (tier, runs) in all(play) {
            let epsilon = if tier.ends_with("f64") || tier == "reference" {
                f64::EPSILON
            } else {
                f64::from(f32::EPSILON)
            };
            for run in runs {
                let bound = f64::from(TICKS) * ULPS_PER_TICK * epsilon * largest(&run);
                assert!(run.unexplained().abs() <= bound, "{name} {tier}: {} of {bound}", run.unexplained());
            }
        }
    }
}

#[test]
fn terms_have_the_signs_of_what_they_are() {
    for (play, name) in Play::ALL {
        for (tier, runs) in all(play) {
            for run in &runs {
                let what = format!("{name} {tier}: {run:?}");
                assert!(of(run, Term::Landing) < 0.0, "{what}");
                assert!(of(run, Term::Stop) <= 0.0 || play == Play::Coast, "{what}");
                // Half of 0.001 m/s squared for each contact.
                let push = f64::from(run.contacts[0]) * 5e-7;
                assert!((of(run, Term::Push) - push).abs() <= 1e-9 * push, "{what}");
                assert_eq!(of(run, Term::Jets) != 0.0, play == Play::Jets, "{what}");
                assert_eq!(of(run, Term::Blast) != 0.0, play == Play::Discs, "{what}");
                assert_eq!(of(run, Term::Jump) != 0.0, play != Play::Coast, "{what}");
            }
        }
    }
}
