//! Samples of rows as text, which a shard's report carries.

use crate::sample::{Sample, row_number};
use lightmeter_catalogue::select::{CaseRef, Member};
use lightmeter_document::report::SampledRows;

/// Why a text is no sample of a group's rows.
#[derive(Debug, thiserror::Error)]
#[error("its sample of cases is damaged: {0}")]
pub struct BadSample(pub &'static str);

/// Rows of a group that were read: of each its values.
pub type ReadRows = Sample<(usize, CaseRef), Vec<f32>>;

/// Writes a sample, of each row what was answered.
#[must_use]
pub fn packed<V>(sample: &Sample<(usize, CaseRef), V>, values: impl Fn(&V) -> Vec<f32>) -> SampledRows {
    let mut bytes = vec![];
    for ((member, case), kept) in sample.rows() {
        number(member as u64, &mut bytes);
        let (kind, numbers): (u8, &[u64]) = match case {
            CaseRef::Hard(place) => (0, &[place as u64]),
            CaseRef::Near(place, k) => (1, &[place as u64, k]),
            CaseRef::Boundary(k) => (2, &[k]),
            CaseRef::Random(k) => (3, &[k]),
        };
        bytes.push(kind);
        numbers.iter().for_each(|&one| number(one, &mut bytes));
        values(kept).iter().for_each(|value| bytes.extend(value.to_bits().to_le_bytes()));
    }
    SampledRows { of: sample.seen, rows: bytes.iter().map(|byte| format!("{byte:02x}")).collect() }
}

/// Reads a sample of at most `most` rows of the whole, where `places` has the place of each of its formulas, and `members` are the whole's, each
/// with the number that its rows are numbered by.
///
/// # Errors
/// Where it is damaged, or names a case that its formula does not have.
pub fn unpacked(
    rows: &SampledRows,
    places: &[usize],
    members: &[(&Member, u64)],
    most: usize,
) -> Result<ReadRows, BadSample> {
    let mut sample = Sample::new(most);
    let (pairs, rest) = rows.rows.as_bytes().as_chunks::<2>();
    let digit = |&byte: &u8| char::from(byte).to_digit(16);
    let byte = |[a, b]: &[u8; 2]| u8::try_from(16 * digit(a)? + digit(b)?).ok();
    let bytes: Option<Vec<u8>> = pairs.iter().map(byte).collect();
    let bytes = bytes.filter(|_| rest.is_empty()).ok_or(BadSample("it is not written in base 16"))?;
    let mut rest = bytes.as_slice();
    let (mut last, mut count) = (None, 0_u64);
    let outputs = members.first().map_or(1, |(member, _)| member.spec.output_len()).max(1);
    while !rest.is_empty() {
        let member = usize::try_from(read(&mut rest)?).ok().and_then(|place| places.get(place).copied());
        let member = member.ok_or(BadSample("a row is of a formula that the group does not have"))?;
        let (kind, after) = rest.split_first().ok_or(BadSample("it ends within a row"))?;
        rest = after;
        let mut place = || usize::try_from(read(&mut rest)?).map_err(|_| BadSample("a case's number is too large"));
        let case = match kind {
            0 => CaseRef::Hard(place()?),
            1 => CaseRef::Near(place()?, read(&mut rest)?),
            2 => CaseRef::Boundary(read(&mut rest)?),
            3 => CaseRef::Random(read(&mut rest)?),
            _ => return Err(BadSample("a row is of no kind that there is")),
        };
        let &(of, number) =
            members.get(member).ok_or(BadSample("a row is of a formula that the group does not have"))?;
        if !of.has(case) {
            return Err(BadSample("a row is of a case that its formula does not have"));
        }
        let (words, after) = rest.split_at_checked(4 * outputs).ok_or(BadSample("it ends within a row"))?;
        rest = after;
        // They are written in their order.
        if last.replace((member, case)).is_some_and(|last| last >= (member, case)) {
            return Err(BadSample("a row stands there twice, or out of its order"));
        }
        count += 1;
        let words = words.as_chunks::<4>().0.iter().map(|&word| f32::from_bits(u32::from_le_bytes(word)));
        sample.push((member, case), row_number(number, case), || words.collect());
    }
    if count != rows.of.min(most as u64) {
        return Err(BadSample("it has other rows than it says that there are"));
    }
    sample.seen = rows.of;
    Ok(sample)
}

/// Writes a number as LEB128.
fn number(mut number: u64, out: &mut Vec<u8>) {
    while number >= 0x80 {
        out.push((number & 0x7f) as u8 | 0x80);
        number >>= 7;
    }
    #[expect(clippy::cast_possible_truncation, reason = "seven bits")]
    out.push(number as u8);
}

fn read(rest: &mut &[u8]) -> Result<u64, BadSample> {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let (&byte, after) = rest.split_first().ok_or(BadSample("it ends within a number"))?;
        *rest = after;
        number |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Ok(number);
        }
    }
    Err(BadSample("a number is too large"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightmeter_catalogue::select::catalogue;
    use proptest::prelude::*;
    use std::collections::HashSet;

    proptest! {
        #[test]
        fn what_is_written_is_read(numbers in proptest::collection::vec((0..4_u8, any::<u64>(), any::<f32>()), 0..40)) {
            let catalogue = catalogue();
            let member = catalogue.iter().find(|member| member.spec.id == "fog/exp").expect("it is there");
            let outputs = member.spec.output_len();
            let hard = member.spec.hard.len() as u64;
            let (mut sample, mut seen) = (Sample::new(16), HashSet::new());
            for (kind, k, value) in numbers {
                let place = usize::try_from(k % hard).expect("it is small");
                let case = match kind {
                    0 => CaseRef::Hard(place),
                    1 => CaseRef::Near(place, k % member.near()),
                    2 => CaseRef::Boundary(k % member.boundary().max(1)),
                    _ => CaseRef::Random(k),
                };
                if seen.insert(case) {
                    sample.push((0, case), row_number(member.number, case), || vec![value; outputs]);
                }
            }
            let again = unpacked(&packed(&sample, Vec::clone), &[0], &[(member, member.number)], 16);
            let bits = |values: &Vec<f32>| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            prop_assert!(again.is_ok_and(|again| again.is_like(&sample, |a, b| bits(a) == bits(b))));
        }

        #[test]
        fn any_text_is_read_or_refused(rows in "[0-9a-fg]{0,128}") {
            let catalogue = catalogue();
            let member = &catalogue[0];
            let _ = unpacked(&SampledRows { of: 1, rows }, &[0], &[(member, member.number)], 8);
        }
    }
}
