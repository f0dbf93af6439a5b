//! What the files of a crate import from each other, and its public types, read from its sources. Tests (`#[cfg(test)]`) are left
//! out.

use lightmeter_tests::place::folder;
use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};
use syn::{Attribute, Item, ItemMod, ItemUse, Macro, UseTree, Visibility};

/// The names that a file takes from another, by the module paths of both files: `crate::outer::inner`, and `crate` for the root.
pub(crate) type Imports = BTreeMap<(String, String), BTreeSet<String>>;

/// Names that `::` joins.
type Names = Vec<String>;

/// A module as it is written.
#[derive(Default)]
struct Module {
    file: PathBuf,
    /// What stands behind each name that a `use` brings into scope.
    uses: BTreeMap<String, Names>,
    /// Every path that is written in it.
    paths: Vec<Names>,
    /// The types and traits that it declares `pub`.
    types: Vec<String>,
}

/// The modules of a crate, by their paths from its root.
#[derive(Default)]
struct Modules {
    all: BTreeMap<Names, Module>,
    /// The module that is being read.
    here: Names,
}

/// The imports between the files of the crate with this root file.
pub(crate) fn imports(root: &Path) -> Imports {
    let mut modules = Modules::default();
    modules.read(root.to_owned());
    let mut imports = Imports::new();
    for (here, module) in &modules.all {
        for (there, name) in module.paths.iter().filter_map(|path| modules.definition(here, path)) {
            if module.file != modules.all[&there].file {
                imports.entry((modules.file_path(here), modules.file_path(&there))).or_default().insert(name);
            }
        }
    }
    imports
}

/// The types and traits that the crate with this root file declares `pub`, with their files. The compiler's lint `unreachable_pub`
/// ensures that they are visible outside of the crate. Types that a macro declares are left out.
pub(crate) fn public_types(root: &Path) -> Vec<(String, PathBuf)> {
    let mut modules = Modules::default();
    modules.read(root.to_owned());
    let types = |module: Module| module.types.into_iter().map(move |name| (name, module.file.clone()));
    modules.all.into_values().flat_map(types).collect()
}

impl Modules {
    /// The module path of the file that a module is written in: its own path, or that of a module around it.
    fn file_path(&self, module: &[String]) -> String {
        let file = &self.all[module].file;
        let around = (0..=module.len()).map(|length| &module[..length]);
        let outermost = around.into_iter().find(|outer| self.all[*outer].file == *file).unwrap_or(module);
        std::iter::once("crate").chain(outermost.iter().map(String::as_str)).collect::<Vec<_>>().join("::")
    }

    /// The module that defines what a path names, by way of re-exports, and its name there; `None` for a module. What belongs to
    /// another crate counts as defined where it is named.
    fn definition(&self, here: &[String], path: &[String]) -> Option<(Names, String)> {
        let (first, rest) = path.split_first()?;
        let child = [here, std::slice::from_ref(first)].concat();
        match first.as_str() {
            "crate" => self.definition(&[], rest),
            "self" => self.definition(here, rest),
            "super" => self.definition(&here[..here.len() - 1], rest),
            _ if self.all.contains_key(&child) => self.definition(&child, rest),
            name => match self.all[here].uses.get(name) {
                Some(used) if used[0] != name => self.definition(here, &[used, rest].concat()),
                _ => Some((here.to_vec(), name.to_owned())),
            },
        }
    }

    /// Reads a file as the module `here`, with its descendants.
    fn read(&mut self, file: PathBuf) {
        let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        let parsed = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        self.all.insert(self.here.clone(), Module { file, ..Module::default() });
        self.visit_file(&parsed);
    }

    fn module(&mut self) -> &mut Module {
        self.all.get_mut(&self.here).expect("it is being read")
    }

    /// The file of a child of the module `here`.
    fn file_of(&mut self, child: &str) -> PathBuf {
        let is_root = self.here.is_empty();
        let file = &self.module().file;
        let folder =
            if is_root || file.ends_with("mod.rs") { file.with_file_name("") } else { file.with_extension("") };
        let plain = folder.join(child).with_extension("rs");
        if plain.is_file() { plain } else { folder.join(child).join("mod.rs") }
    }

    /// Notes what a `use` names, each name after the path that stands before it.
    fn note_use(&mut self, before: &[String], tree: &UseTree) {
        let with = |name: &dyn ToString| [before, &[name.to_string()]].concat();
        let (name, path) = match tree {
            UseTree::Path(path) => return self.note_use(&with(&path.ident), &path.tree),
            UseTree::Group(group) => return group.items.iter().for_each(|tree| self.note_use(before, tree)),
            UseTree::Name(name) if name.ident == "self" => {
                (before.last().cloned().unwrap_or_default(), before.to_vec())
            }
            UseTree::Name(name) => (name.ident.to_string(), with(&name.ident)),
            UseTree::Rename(renamed) => (renamed.rename.to_string(), with(&renamed.ident)),
            UseTree::Glob(_) => ("*".to_owned(), with(&"*")),
        };
        self.module().paths.push(path.clone());
        self.module().uses.insert(name, path);
    }

    /// Notes the paths among the tokens of a macro.
    fn note_tokens(&mut self, tokens: &TokenStream) {
        let (mut path, mut colons) = (Names::new(), 0);
        for token in tokens.clone() {
            match token {
                TokenTree::Punct(mark) if mark.as_char() == ':' => {
                    colons += 1;
                    continue;
                }
                TokenTree::Ident(name) => {
                    if colons != 2 {
                        self.module().paths.push(std::mem::take(&mut path));
                    }
                    path.push(name.to_string());
                }
                TokenTree::Group(group) => self.note_tokens(&group.stream()),
                TokenTree::Punct(_) | TokenTree::Literal(_) => {}
            }
            colons = 0;
        }
        self.module().paths.push(path);
    }
}

impl<'ast> Visit<'ast> for Modules {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes = match item {
            Item::Fn(function) => &function.attrs[..],
            Item::Mod(module) => &module.attrs[..],
            Item::Use(used) => &used.attrs[..],
            _ => &[],
        };
        if !attributes.iter().any(is_for_tests) {
            if let Some(name) = public_type(item) {
                self.module().types.push(name);
            }
            visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        // A file that is named by its path is a module of another target, too, and is read there.
        if module.attrs.iter().any(|attribute| attribute.path().is_ident("path")) {
            return;
        }
        let name = module.ident.to_string();
        let file = if module.content.is_some() { self.module().file.clone() } else { self.file_of(&name) };
        self.here.push(name);
        if module.content.is_some() {
            self.all.insert(self.here.clone(), Module { file, ..Module::default() });
            visit::visit_item_mod(self, module);
        } else {
            self.read(file);
        }
        self.here.pop();
    }

    fn visit_item_use(&mut self, used: &'ast ItemUse) {
        self.note_use(&[], &used.tree);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.module().paths.push(names);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'ast Macro) {
        visit::visit_macro(self, called);
        self.note_tokens(&called.tokens);
    }

    fn visit_visibility(&mut self, _: &'ast Visibility) {}
}

/// The name of an item that is a type or a trait and `pub`.
fn public_type(item: &Item) -> Option<String> {
    let (visibility, name) = match item {
        Item::Enum(item) => (&item.vis, &item.ident),
        Item::Struct(item) => (&item.vis, &item.ident),
        Item::Trait(item) => (&item.vis, &item.ident),
        Item::Type(item) => (&item.vis, &item.ident),
        Item::Union(item) => (&item.vis, &item.ident),
        _ => return None,
    };
    matches!(visibility, Visibility::Public(_)).then(|| name.to_string())
}

fn is_for_tests(attribute: &Attribute) -> bool {
    attribute.path().is_ident("cfg") && attribute.parse_args::<syn::Ident>().is_ok_and(|name| name == "test")
}

#[test]
fn names_are_followed_to_the_files_that_define_them() {
    let folder = folder("imports");
    std::fs::create_dir_all(folder.join("outer")).expect("a folder can be made");
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod outer;"),
        (
            "a.rs",
            "use crate::outer::Inner;\nfn f() { print!(\"{}\", super::b::g()) }\n#[cfg(test)]\nmod t { use crate::b::T; }",
        ),
        ("b.rs", "use super::a::{f as renamed, self};\nuse std::fmt;\nfn g(x: impl fmt::Debug) -> a::F { renamed(x) }"),
        ("outer/mod.rs", "mod inner;\npub use inner::Inner;\nfn parent() { inner::child() }"),
        ("outer/inner.rs", "use crate::{a, outer::parent};\nstruct Inner { f: Vec<a::F>, x: i32 }"),
    ];
    for (name, text) in files {
        std::fs::write(folder.join(name), text).expect("a file can be written");
    }
    let imports = imports(&folder.join("lib.rs"));
    let found: Vec<String> = imports.iter().map(|((from, to), names)| format!("{from} -> {to}: {names:?}")).collect();
    let expected = [
        "crate::a -> crate::b: {\"g\"}",
        "crate::a -> crate::outer::inner: {\"Inner\"}",
        "crate::b -> crate::a: {\"F\", \"f\"}",
        "crate::outer -> crate::outer::inner: {\"Inner\", \"child\"}",
        "crate::outer::inner -> crate::a: {\"F\"}",
        "crate::outer::inner -> crate::outer: {\"parent\"}",
    ];
    assert_eq!(found, expected);
}

#[test]
fn public_types_are_found_in_every_module() {
    let folder = folder("types");
    let files = [
        (
            "lib.rs",
            "mod a;\npub struct A;\npub(crate) struct B;\nstruct C;\npub mod inner { pub trait D {} pub enum E {} }",
        ),
        (
            "a.rs",
            "pub type A = u8;\npub union U { f: u8 }\npub fn f() {}\npub use crate::B;\n#[cfg(test)]\nmod t { pub struct T; }",
        ),
    ];
    for (name, text) in files {
        std::fs::write(folder.join(name), text).expect("a file can be written");
    }
    let found: Vec<String> = public_types(&folder.join("lib.rs"))
        .into_iter()
        .map(|(name, file)| format!("{} {name}", file.strip_prefix(&folder).expect("a file of the folder").display()))
        .collect();
    assert_eq!(found, ["lib.rs A", "a.rs A", "a.rs U", "lib.rs D", "lib.rs E"]);
}
