//! What there is to know of a run besides its verdicts: deviations, skips, images, stores, hard cases.

use crate::Level;
use lightmeter_document::report::{BlendState, DeviationUse, Group, ImageUse, Report, Tiers};
use lightmeter_document::{Number, thousands};
use lightmeter_scene::blend::Route;
use lightmeter_scene::target::TargetFormat;
use std::collections::BTreeMap;
use std::fmt::{Result, Write};

pub(super) fn notes(report: &Report, level: Level, out: &mut impl Write) -> Result {
    deviations(report, level, out)?;
    skips(report, level, out)?;
    if level > Level::Quiet {
        legal_biases(report, out)?;
    }
    if level == Level::Verbose {
        stores(report, out)?;
        images(report, out)?;
        stability(report, out)?;
    }
    for special in report.special.iter().filter(|special| !special.is_as_recorded()) {
        let (seen, recorded) = (&special.seen, special.recorded.as_deref().unwrap_or_default());
        writeln!(
            out,
            "{} on {}, {}: {seen}, where {recorded} is on record",
            special.id, special.adapter, special.target
        )?;
    }
    if level == Level::Verbose && !report.routes.is_empty() {
        let states: u64 = report.routes.values().filter_map(serde_json::Value::as_u64).sum();
        // They went another way before.
        let dual = report.routes.get(Route::DualSource.name()).and_then(serde_json::Value::as_u64).unwrap_or(0);
        let routes: Vec<String> = report.routes.iter().map(|(route, states)| format!("{states} {route}")).collect();
        writeln!(
            out,
            "blend states: {} judged ({}), {} more are aliases of those",
            thousands(states.saturating_sub(dual)),
            routes.join(", "),
            thousands(report.aliases)
        )?;
    }
    Ok(())
}

/// The known deviations of each adapter: those that are still needed on one line, unless all is to be told.
fn deviations(report: &Report, level: Level, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        let is_of = |deviation: &&DeviationUse| deviation.adapter == adapter.name;
        let (needed, not_needed): (Vec<_>, Vec<_>) =
            report.deviations.iter().filter(is_of).partition(|deviation| deviation.still_needed);
        if level == Level::Verbose {
            needed.iter().try_for_each(|deviation| self::deviation(deviation, out))?;
        } else if level == Level::Normal && !needed.is_empty() {
            let names: Vec<&str> = needed.iter().map(|deviation| deviation.name.as_ref()).collect();
            let excused: u64 = needed.iter().map(|deviation| deviation.excused).sum();
            let excuse =
                if excused > 0 { format!("; they excuse {} verdicts", thousands(excused)) } else { String::new() };
            writeln!(out, "known deviations of {}, seen again: {}{excuse}", adapter.name, names.join(", "))?;
        }
        not_needed.iter().try_for_each(|deviation| self::deviation(deviation, out))?;
    }
    Ok(())
}

/// What was skipped, with the reason that several groups have in common. What a renderer does not declare is only counted elsewhere, but where
/// it was asked for by name.
fn skips(report: &Report, level: Level, out: &mut impl Write) -> Result {
    let is_told = |group: &Group| level == Level::Verbose || !group.is_not_asked() || report.is_named(group);
    let mut groups = BTreeMap::<_, Vec<&str>>::new();
    for group in report.groups.iter().filter(|group| is_told(group)) {
        if let Some(reason) = &group.skip_reason {
            groups.entry((&group.adapter, group.place(), reason)).or_default().push(&group.id);
        }
    }
    for ((adapter, place, reason), ids) in groups {
        let which = match ids.as_slice() {
            [one] => (*one).to_owned(),
            [first, .., last] => format!("{} groups, from {first} to {last},", ids.len()),
            [] => continue,
        };
        writeln!(out, "skipped {which} on {adapter}, {place}: {reason}")?;
    }
    let mut routes = BTreeMap::<_, u64>::new();
    let on_targets = |state: &&BlendState| {
        let group = report
            .groups
            .iter()
            .find(|group| group.adapter == state.adapter && group.target.as_ref() == Some(&state.target));
        group.is_some_and(|group| group.skip_reason.is_none())
    };
    for state in report.blend_states.iter().filter(on_targets) {
        if let Some(reason) = &state.skip_reason {
            *routes.entry((&state.adapter, &state.target, &state.route, reason)).or_default() += 1;
        }
    }
    for ((adapter, target, route, reason), states) in routes {
        writeln!(out, "skipped {states} states by {route} on {adapter}, {target}: {reason}")?;
    }
    Ok(())
}

/// Whether a named deviation is still needed, and what it excused.
///
/// # Errors
/// Where the writer fails.
pub fn deviation(deviation: &DeviationUse, out: &mut impl Write) -> Result {
    let DeviationUse { name, adapter, reason, .. } = deviation;
    let state = if deviation.still_needed {
        "seen again, so it is granted".to_owned()
    } else {
        format!("no longer seen: take it out ({reason})")
    };
    write!(out, "known deviation {name} of {adapter}: {state}")?;
    match deviation.excused {
        0 => writeln!(out, "; no verdict needed it"),
        1 => writeln!(out, "; it excuses 1 verdict"),
        more => writeln!(out, "; it excuses {} verdicts", thousands(more)),
    }
}

/// Of scenes, by adapter: how many pixels are marked, whether both kinds of shader draw alike, and what all effects cost.
fn images(report: &Report, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        let of_adapter = report.groups.iter().filter(|group| group.adapter == adapter.name);
        let images: Vec<_> = of_adapter.filter_map(|group| Some((group, group.image.as_ref()?))).collect();
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        let share =
            |(group, image): &(&Group, &ImageUse)| 100.0 * image.marked as f64 / group.totals.cases.max(1) as f64;
        let Some(most) = images.iter().max_by(|a, b| share(a).total_cmp(&share(b))) else { continue };
        write!(out, "images of {}: at most {:.3} % of the pixels marked ({})", adapter.name, share(most), most.0.id)?;
        let differing: Vec<u64> = images.iter().filter_map(|(_, image)| image.differs_from_composed).collect();
        if !differing.is_empty() {
            let alike = differing.iter().filter(|&&pixels| pixels == 0).count();
            let pixels: u64 = differing.iter().sum();
            let of = differing.len();
            write!(out, "; {alike} of {of} are the same bit for bit by the shader with all effects")?;
            if pixels > 0 {
                write!(out, ", {} pixels of the others differ", thousands(pixels))?;
            }
        }
        writeln!(out)?;
        for (group, image) in &images {
            if let Some(cost) = image.cost {
                writeln!(
                    out,
                    "  {:<26} {:>8.2} ms composed, {:>8.2} ms with all effects: {:.2} times (quartiles {:.2} to {:.2})",
                    group.id, cost.composed_ms, cost.full_ms, cost.ratio, cost.quartiles[0], cost.quartiles[1]
                )?;
            }
        }
    }
    Ok(())
}

/// On targets of 8 bits: how near values come, and how they are stored.
fn stores(report: &Report, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        for target in TargetFormat::ALL {
            let groups = || {
                let of =
                    |group: &&Group| group.adapter == adapter.name && group.target.as_deref() == Some(target.name());
                report.groups.iter().filter(of)
            };
            let mut tiers = Tiers::default();
            groups().filter_map(|group| group.tiers).for_each(|of| tiers.add(&of));
            let all: u64 = tiers.named().into_iter().map(|(_, count)| count).sum();
            if all == 0 {
                continue;
            }
            #[expect(clippy::cast_precision_loss, reason = "a share")]
            let share = |count: u64| 100.0 * count as f64 / all as f64;
            let shares = tiers.named().map(|(name, count)| format!("{name} {:.2} %", share(count)));
            let mut stores: Vec<&str> = groups().filter_map(|group| Some(&*group.store.as_ref()?.identified)).collect();
            stores.sort_unstable();
            stores.dedup();
            let stores = if stores.is_empty() { "too few values to tell".into() } else { stores.join(", ") };
            writeln!(out, "{} of {}: {}; stored: {stores}", target.name(), adapter.name, shares.join(", "))?;
        }
    }
    Ok(())
}

/// Images that lie to one side of their reference by no more than the accuracy rules permit: a line for all stages that show the same.
fn legal_biases(report: &Report, out: &mut impl Write) -> Result {
    let mut told: Vec<(&str, &str, String, Vec<&str>)> = vec![];
    for group in &report.groups {
        let bias = group.image.as_ref().and_then(|image| image.bias).filter(|bias| bias.beyond.is_none());
        let Some(bias) = bias else { continue };
        let says = format!("{}, {} on average", bias.as_if(), bias.on_average());
        match told
            .iter_mut()
            .find(|(id, adapter, other, _)| (*id, *adapter) == (&*group.id, &*group.adapter) && *other == says)
        {
            Some((.., stages)) => stages.push(&group.stage),
            None => told.push((&group.id, &group.adapter, says, vec![&group.stage])),
        }
    }
    for (id, adapter, says, stages) in told {
        let stages = stages.join(", ");
        writeln!(out, "{id} on {adapter} ({stages}) lies to one side, which is legal there: {says}")?;
    }
    Ok(())
}

/// What the first drawing of the blend states costs, and the second, by adapter: the product of factors and equations, and
/// apart from it the states with another one for alpha.
pub(super) fn blend_timing(report: &Report, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        let groups = || report.groups.iter().filter(|group| group.adapter == adapter.name);
        for (what, separate) in [("blend unit", false), ("states separate for alpha", true)] {
            let of =
                || groups().filter(|group| (group.id == "blend/separate") == separate && group.seconds_warm.is_some());
            let (cold, warm) = of().fold((0.0, 0.0), |(cold, warm), group| {
                (cold + group.seconds, warm + group.seconds_warm.unwrap_or_default())
            });
            if of().next().is_some() {
                writeln!(
                    out,
                    "{what} of {}: {cold:.2} s at first, {warm:.2} s again, so {:.2} s are the driver's compilation",
                    adapter.name,
                    (cold - warm).max(0.0)
                )?;
            }
        }
    }
    Ok(())
}

/// How many hard cases the stable forms keep their claims at, and where a naive form does better than it is known for.
fn stability(report: &Report, out: &mut impl Write) -> Result {
    for adapter in &report.adapters {
        let on_adapter: Vec<_> = report.stability.iter().filter(|one| one.adapter == adapter.name).collect();
        if on_adapter.is_empty() {
            continue;
        }
        let (kept, fails) = (
            on_adapter.iter().filter(|one| one.is_stable()).count(),
            on_adapter.iter().filter(|one| one.naive_fails()).count(),
        );
        writeln!(
            out,
            "hard cases of {}, by stage: the stable form keeps its bound at {kept} of {}, the naive form fails at {fails}",
            adapter.name,
            on_adapter.len()
        )?;
        for one in on_adapter.iter().filter(|one| !one.naive_fails()) {
            writeln!(
                out,
                "  {} does not fail at {} here, {}: {} roundings, said to be {} at least",
                one.naive_formula,
                one.id,
                one.stage,
                Number(one.naive.0.round()),
                one.naive_at_least
            )?;
        }
    }
    Ok(())
}
