//! A sample of the mutants of the shaders: the suite notices each, or `tests/mutants.txt` says what it is. `./x mutants` judges all of them.

use lightmeter::adapters;
use lightmeter_tests::mutants::{Campaign, Mutant, MutantClass, Survivors, mutants};
use std::collections::BTreeSet;

/// One in this many mutants of the formulas is judged here.
const EVERY: usize = 23;

fn all(campaign: &Campaign) -> Vec<Mutant> {
    campaign.shaders().texts().flat_map(|(file, text)| mutants(file, text)).collect()
}

#[test]
fn a_sample_of_the_mutants_is_killed_or_known() {
    if lightmeter_tests::needs::lacks_driver() {
        return;
    }
    let subject = adapters::open(&[]).expect("there is an adapter").swap_remove(0);
    let mut campaign = Campaign::new(subject).expect("the built-in shaders are valid");
    let known = Survivors::read().expect("the list can be read");
    let all = all(&campaign);
    // Those of scenes, of fixed functions and of all blend states take too long here.
    let sample: Vec<&Mutant> = all.iter().filter(|mutant| campaign.is_of_formulas(mutant)).step_by(EVERY).collect();
    let (mut killed, mut unknown) = (0, vec![]);
    for mutant in &sample {
        // What is known to survive was told apart by a million inputs, which take too long here.
        let is_noticed = campaign.is_noticed(mutant).expect("the device does not fail");
        match is_noticed {
            Some(true) => killed += 1,
            Some(false) if known.class(mutant).is_none() => unknown.push(mutant.name()),
            Some(false) | None => {}
        }
    }
    assert!(unknown.is_empty(), "no run notices these: {unknown:#?}");
    assert!(killed * 2 > sample.len(), "{killed} of {}", sample.len());
}

#[test]
fn every_known_survivor_is_a_mutant() {
    let shaders = lightmeter_gpu::Shaders::built_in().expect("the built-in shaders are valid");
    let names: BTreeSet<String> =
        shaders.texts().flat_map(|(file, text)| mutants(file, text)).map(|mutant| mutant.name()).collect();
    let known = Survivors::read().expect("the list can be read");
    let gone: Vec<&str> = known.names().filter(|name| !names.contains(*name)).collect();
    assert!(gone.is_empty(), "these are mutants no longer; `./x mutants --update` renews the list: {gone:#?}");
    assert!(known.count(MutantClass::Equal) > 0);
}
