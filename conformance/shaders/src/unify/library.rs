//! Templates as values on samples, ready to be found.

use super::class::{Class, Random};
use super::is_close;
use crate::graph::{Evaluation, Graph, NodeId, Origin, Type, Value};
use crate::lower::{Declared, Lowering};
use crate::templates::{self, Head};
use naga::Span;

/// Inputs on which two functions are compared.
pub(super) const SAMPLES: usize = 40;
/// Operations that a template has at most.
pub(super) const MOST_OPERATIONS: usize = 60;

/// A step's form: a function, what it is called, and what is to be said of it.
#[derive(Debug)]
pub(crate) struct Template {
    pub(crate) head: Head,
    /// The name of its function.
    pub(crate) name: String,
    /// In the order of its group's slots.
    pub(crate) parameters: Vec<(String, Class)>,
    /// The place in the text.
    pub(super) order: usize,
}

/// A template's values where some unit vectors are meant with the other sign.
#[derive(Debug)]
pub(super) struct Form {
    pub(super) template: usize,
    /// Of each slot, whether it is negated.
    pub(super) negated: Vec<bool>,
    pub(super) values: Vec<Value<f64>>,
}

/// Templates whose parameters are of the same types and classes.
#[derive(Debug)]
pub(super) struct Group {
    pub(super) types: Vec<Type>,
    key: Vec<(Type, Class)>,
    pub(super) samples: Vec<Vec<Value<f64>>>,
    /// By the first number of the first sample.
    pub(super) forms: Vec<Form>,
}

/// All templates.
#[derive(Debug)]
pub(crate) struct Library {
    pub(crate) templates: Vec<Template>,
    pub(super) groups: Vec<Group>,
}

/// WGSL that declares nothing.
pub(crate) struct Plain;

impl Declared for Plain {
    fn line(&self, _: Span) -> u32 {
        0
    }
    fn origin(&self, _: &str) -> Option<Origin> {
        None
    }
    fn is_output(&self, _: &str) -> bool {
        false
    }
    fn zeroes_locals(&self) -> bool {
        true
    }
}

impl Library {
    /// Reads the templates.
    ///
    /// # Errors
    /// Which is not as it should be: none that is built in.
    pub(crate) fn new() -> Result<Self, String> {
        let (text, heads) = templates::all()?;
        let module = naga::front::wgsl::parse_str(&text).map_err(|error| error.emit_to_string(&text))?;
        let mut own = Self { templates: vec![], groups: vec![] };
        for (_, function) in module.functions.iter() {
            let name = function.name.clone().unwrap_or_default();
            let (order, head) = heads
                .iter()
                .enumerate()
                .find(|(_, (own, _))| *own == name)
                .map(|(k, (_, head))| (k, head.clone()))
                .ok_or(&*name)?;
            let mut lowering = Lowering::new(&module, &Plain);
            let root = lowering.root(function, &name, false);
            let value = root.outputs.first().ok_or(&*name)?.value;
            let mut parameters: Vec<(Type, Class, String, NodeId)> = vec![];
            for argument in &function.arguments {
                let name = argument.name.clone().unwrap_or_default();
                let class = Class::of_name(&name).ok_or_else(|| format!("`{name}` has no class"))?;
                let ty =
                    lowering.graph.ids().find(|id| lowering.graph.leaf_of(*id).is_some_and(|leaf| leaf.name == name));
                let id = ty.ok_or(&*name)?;
                parameters.push((lowering.graph.ty(id), class, name, id));
            }
            parameters.sort_by_key(|own| (own.0, own.1));
            let template = Template {
                head,
                name: name.clone(),
                parameters: parameters.iter().map(|own| (own.2.clone(), own.1)).collect(),
                order,
            };
            own.add(template, &parameters, &lowering.graph, value).ok_or(name)?;
        }
        for group in &mut own.groups {
            group.forms.sort_by(|a, b| a.values[0].first().total_cmp(&b.values[0].first()));
        }
        Ok(own)
    }

    fn add(
        &mut self,
        template: Template,
        parameters: &[(Type, Class, String, NodeId)],
        graph: &Graph,
        root: NodeId,
    ) -> Option<()> {
        let key: Vec<(Type, Class)> = parameters.iter().map(|own| (own.0, own.1)).collect();
        let cut: Vec<NodeId> = parameters.iter().map(|own| own.3).collect();
        let evaluation = Evaluation::new(graph, root, &cut, MOST_OPERATIONS)?;
        let at = self.groups.iter().position(|group| group.key == key).unwrap_or_else(|| {
            let mut random = Random::new(self.groups.len() as u64 + 1);
            (0..20).for_each(|_| _ = random.share());
            let sample = |_| key.iter().map(|(ty, class)| class.sample(*ty, &mut random)).collect();
            let samples = (0..SAMPLES).map(sample).collect();
            let types = key.iter().map(|own| own.0).collect();
            self.groups.push(Group { types, key: key.clone(), samples, forms: vec![] });
            self.groups.len() - 1
        });
        let group = &mut self.groups[at];
        let number = self.templates.len();
        let mut buffer = vec![];
        let mut own: Vec<Form> = vec![];
        for negated in signs(&template) {
            let value = |sample: &Vec<Value<f64>>| {
                let turned = |(value, is): (&Value<f64>, &bool)| if *is { value.map(|own| -own) } else { *value };
                let given: Vec<Value<f64>> = sample.iter().zip(&negated).map(turned).collect();
                evaluation.value(&given, &mut buffer)
            };
            let values: Vec<Value<f64>> = group.samples.iter().map(value).collect();
            let is_new = !own.iter().any(|form| form.values.iter().zip(&values).all(|(a, b)| is_close(a, b, 1e-9)));
            if is_new {
                own.push(Form { template: number, negated, values });
            }
        }
        group.forms.extend(own);
        self.templates.push(template);
        Some(())
    }
}

/// Which unit vectors may be meant with the other sign: few first, and the normal last.
fn signs(template: &Template) -> Vec<Vec<bool>> {
    let units: Vec<usize> =
        (0..template.parameters.len()).filter(|k| template.parameters[*k].1 == Class::Unit).collect();
    let weight = |k: usize| match &*template.parameters[k].0 {
        "n" => 10,
        "v" => 2,
        _ => 3,
    };
    let mut all: Vec<Vec<bool>> = (0..1_usize << units.len())
        .map(|mask| {
            let is_turned = |k: usize| units.iter().position(|own| *own == k).is_some_and(|bit| mask >> bit & 1 == 1);
            (0..template.parameters.len()).map(is_turned).collect()
        })
        .collect();
    all.sort_by_key(|own: &Vec<bool>| {
        own.iter().enumerate().filter(|(_, is)| **is).map(|(k, _)| weight(k)).sum::<i32>()
    });
    all
}
