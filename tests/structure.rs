//! The house's rules that can be checked: a formula family has its four files, every shader function of the catalogue is
//! there with the right signature, and no formula lacks hard data. None of this needs a GPU.

use lightmeter::cases::{FAMILIES, Kind};
use lightmeter::select::{CaseRef, catalogue};
use lightmeter_gpu::{FILES, Kernel, Shaders};
use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn every_family_has_its_four_files() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace's root");
    for family in FAMILIES {
        for file in [
            format!("reference/src/{family}.rs"),
            format!("gpu/src/shaders/{family}.wgsl"),
            format!("conformance/src/cases/{family}.rs"),
            format!("tests/properties/{family}.rs"),
        ] {
            assert!(root.join(&file).is_file(), "family `{family}` lacks {file}");
        }
    }
}

#[test]
fn every_family_of_the_catalogue_is_listed_and_has_hard_cases() {
    let catalogue = catalogue();
    let families: BTreeSet<&str> = catalogue.iter().map(|member| member.spec.family()).collect();
    assert_eq!(families, FAMILIES.into_iter().collect());
    for family in FAMILIES {
        assert!(
            catalogue.iter().any(|m| m.spec.family() == family && !m.spec.hard.is_empty()),
            "{family} has no hard case"
        );
    }
}

#[test]
fn every_shader_is_valid_without_a_gpu() {
    let shaders = Shaders::built_in().expect("the built-in shaders are valid");
    for (file, _) in FILES {
        shaders.parse(file).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn every_formula_has_its_shader_function_with_its_signature() {
    let shaders = Shaders::built_in().expect("the built-in shaders are valid");
    for member in catalogue() {
        let spec = &member.spec;
        match spec.kind {
            Kind::Raster(raster) => {
                assert_eq!((raster.inputs(), raster.outputs()), (spec.input_len(), spec.output_len()), "{}", spec.id);
            }
            // The blend unit alone: no shader function.
            Kind::Blend(_) if spec.row_stages().is_empty() => assert_eq!(spec.function, "", "{}", spec.id),
            Kind::Arithmetic | Kind::Blend(_) | Kind::Depth(_) => {
                let kernel = Kernel::new(&shaders, &format!("{}.wgsl", spec.family()), spec.function);
                let kernel = kernel.unwrap_or_else(|error| panic!("{}: {error}", spec.id));
                assert_eq!(kernel.inputs, spec.selectors.len() + spec.input_len(), "{}", spec.id);
                assert_eq!(kernel.outputs, spec.output_len(), "{}", spec.id);
            }
        }
    }
}

#[test]
fn ids_are_unique_and_read_back() {
    let catalogue = catalogue();
    let mut seen = BTreeSet::new();
    for member in &catalogue {
        let hard = (0..member.spec.hard.len()).map(CaseRef::Hard);
        let near = (0..member.spec.hard.len()).flat_map(|k| (0..member.near()).map(move |n| CaseRef::Near(k, n)));
        let hard = hard.chain(near);
        for case in [CaseRef::Random(0), CaseRef::Random(1_234_567)].into_iter().chain(hard) {
            let id = member.case_id(case);
            assert_eq!(member.case(&id), Some(case), "{id}");
            assert!(seen.insert(id.clone()), "{id} stands twice");
        }
    }
}

#[test]
fn hard_cases_name_inputs_of_their_formula() {
    for member in catalogue() {
        for hard in member.spec.hard {
            for (name, values) in hard.inputs {
                let place = member.spec.place(name);
                assert_eq!(
                    place.map(|place| place.len()),
                    Some(values.len()),
                    "{} {}: {name}",
                    member.spec.id,
                    hard.name
                );
            }
        }
    }
}

#[test]
fn inputs_follow_from_seed_id_and_number_alone() {
    for member in catalogue().iter().filter(|member| member.spec.family() != "blend") {
        let draw = |k, seed| {
            let mut row = vec![];
            member.inputs(CaseRef::Random(k), seed, &mut row);
            row.into_iter().map(f32::to_bits).collect::<Vec<_>>()
        };
        assert_eq!(draw(17, 1), draw(17, 1));
        assert_ne!((draw(17, 1), draw(18, 1)), (draw(17, 2), draw(18, 2)), "{}: the seed matters", member.spec.id);
        assert_ne!(draw(17, 1), draw(19, 1), "{}: the number matters", member.spec.id);
    }
}
