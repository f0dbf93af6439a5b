//! Every formula at every rung of the ladder, and which rungs an adapter has.

use super::Bench;
use super::contest::{Arithmetic, Contender, On, Sample, contest};
use super::ended::BenchError;
use lightmeter_catalogue::cases::Kind;
use lightmeter_catalogue::cases::blend::Program;
use lightmeter_catalogue::select::Member;
use lightmeter_document::bench::{BenchGroup, GroupKind, RungUse};
use lightmeter_gpu::Rung;

/// What a rung is, in a line.
pub(super) const fn what(rung: Rung) -> &'static str {
    match rung {
        Rung::F16 => "binary16: inputs are rounded to it, all is computed in it",
        Rung::Cheap => "f32 with Schlick's power, exponentials and logarithms by the bits",
        Rung::F32 => "f32 as published",
        Rung::Stable => "f32 with the stable form of each step that has one",
        Rung::DoubleFloat => "sums of two f32, by error-free transforms",
        Rung::F64 => "binary64, with exponentials and powers of our own",
    }
}

/// The rungs of an adapter, and those of the processor.
pub(super) fn rungs(ladder: &[(Rung, Option<String>)]) -> Vec<RungUse> {
    let device = ladder.iter().map(|(rung, unavailable)| RungUse {
        name: rung.name().into(),
        what: what(*rung).into(),
        unavailable: unavailable.clone(),
    });
    let processor = Arithmetic::ALL.into_iter().map(|arithmetic| RungUse {
        name: arithmetic.name().into(),
        what: arithmetic.what().into(),
        unavailable: None,
    });
    device.chain(processor).collect()
}

/// A contender for each rung of the ladder; `name` names one.
pub(super) fn on_device<'a>(
    ladder: &[(Rung, Option<String>)],
    formula: Option<&'a Member>,
    name: impl Fn(Rung) -> String,
) -> Vec<Contender<'a>> {
    let contender = |(rung, unavailable): &(Rung, Option<String>)| Contender {
        name: name(*rung),
        what: what(*rung).into(),
        formula,
        on: On::Device(*rung),
        unavailable: unavailable.clone(),
    };
    ladder.iter().map(contender).collect()
}

/// The formulas, each by itself but for blend states and depth tests: those that one shader function evaluates are a group, and
/// so are those of the unit alone that go by one name. Cases of NaN and infinity, of which nothing is promised, are left out.
pub(super) fn groups(catalogue: &[Member]) -> Vec<(String, Vec<&Member>)> {
    let mut groups: Vec<(String, Vec<&Member>)> = vec![];
    for member in catalogue {
        let spec = &member.spec;
        let id = match spec.kind {
            Kind::Blend(Program::Special(_)) => continue,
            Kind::Blend(_) if spec.function.is_empty() => spec.group().to_owned(),
            _ if !spec.selectors.is_empty() => spec.function.replacen('_', "/", 1),
            _ => spec.id.clone(),
        };
        match groups.iter_mut().find(|(known, members)| {
            *known == id && members[0].spec.inputs == spec.inputs && members[0].spec.outputs == spec.outputs
        }) {
            Some((_, members)) => members.push(member),
            None => groups.push((id, vec![member])),
        }
    }
    groups
}

/// A formula at every rung.
pub(super) fn formula(bench: &Bench<'_>, id: &str, members: &[&Member]) -> Result<BenchGroup, BenchError> {
    let sample = Sample::new(members, bench.setting.cases, bench.setting.seed);
    let mut contenders = on_device(bench.ladder, None, |rung| rung.name().into());
    contenders.extend(Arithmetic::ALL.into_iter().map(|arithmetic| Contender {
        name: arithmetic.name().into(),
        what: arithmetic.what().into(),
        formula: None,
        on: On::Processor(arithmetic),
        unavailable: None,
    }));
    contenders.extend(bench.own.map(|own| Contender {
        name: own.name.clone(),
        what: "the shader that is measured beside them, in f32".into(),
        formula: None,
        on: On::Own,
        unavailable: None,
    }));
    let spec = &members[0].spec;
    let has_shader = !spec.function.is_empty() && bench.gpu.is_some();
    let baseline = if has_shader { Rung::F32.name() } else { Arithmetic::F32.name() };
    let (rows, work) = contest(bench, &sample, &contenders, baseline)?;
    let title =
        if members.len() == 1 { spec.text.into() } else { format!("{} states by one shader function", members.len()) };
    Ok(BenchGroup {
        id: id.into(),
        kind: GroupKind::Formula,
        family: spec.family().into(),
        title,
        ideal: "the formula in f64".into(),
        baseline: baseline.into(),
        unit: "evaluation".into(),
        work,
        rows,
        front: vec![],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::select::catalogue;
    use std::collections::BTreeSet;

    #[test]
    fn no_formula_is_missing_and_no_id_is_there_twice() {
        let catalogue = catalogue();
        let groups = groups(&catalogue);
        let ids: BTreeSet<&str> = groups.iter().map(|(id, _)| id.as_str()).collect();
        assert_eq!(ids.len(), groups.len());
        let there: BTreeSet<&str> =
            groups.iter().flat_map(|(_, members)| members).map(|member| member.spec.id.as_str()).collect();
        let missing: Vec<&str> = catalogue
            .iter()
            .filter(|member| !matches!(member.spec.kind, Kind::Blend(Program::Special(_))))
            .map(|member| member.spec.id.as_str())
            .filter(|id| !there.contains(id))
            .collect();
        assert!(missing.is_empty(), "{missing:?}");
    }

    #[test]
    fn a_group_is_of_one_shader_function() {
        for (id, members) in groups(&catalogue()) {
            let functions: BTreeSet<&str> = members.iter().map(|member| member.spec.function).collect();
            assert_eq!(functions.len(), 1, "{id}: {functions:?}");
        }
    }
}
