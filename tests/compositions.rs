//! Every kernel that can be composed: naga accepts it, nothing is in it that is not called, and
//! what an effect brings is there with the effect and not without.

use candor::effects::{Effect, Effects};
use candor::kernel::{Kernel, Tile, validate};
use candor::scene::Estimator::{self, Explicit, Mis};
use candor::scene::ImageSize;
use candor::viewpoint::Form;
use naga::{Block, Expression, Function, Handle, Module, Statement};
use rayon::prelude::*;
use std::collections::BTreeSet;

const BOUNCES: [u32; 3] = [0, 2, 9];

/// Lights that are sampled: whether several are scanned, or many in a tree, and the forms that
/// are among them.
const LIGHTS: [&[Effect]; 12] = {
    use Effect::{AnchoredLight, FactoredLight, LightScan, LightTree};
    [
        &[FactoredLight],
        &[AnchoredLight],
        &[LightScan, FactoredLight],
        &[LightScan, AnchoredLight],
        &[LightScan, FactoredLight, AnchoredLight],
        &[LightTree, FactoredLight],
        &[LightTree, AnchoredLight],
        &[LightTree, FactoredLight, AnchoredLight],
        // Of a kernel that takes any number of them.
        &[LightScan, LightTree, FactoredLight],
        &[LightScan, LightTree, AnchoredLight],
        &[LightScan, LightTree, FactoredLight, AnchoredLight],
        // None.
        &[],
    ]
};

fn with(effects: Effects, more: &[Effect]) -> Effects {
    more.iter().fold(effects, |effects, &effect| effects.with(effect))
}

/// Sets of effects under an estimator, for paths that scatter or not: those that a scene can
/// call for, and those with room for more lights.
fn sets(estimator: Estimator, bounces: u32) -> Vec<Effects> {
    use Effect::{Anchored, Diffuse, Factored, Glossy, Hierarchy, Interior};
    let own = [Diffuse, Glossy, Factored, Anchored, Interior, Hierarchy];
    let mut sets = Vec::new();
    for flags in 0_u32..1 << own.len() {
        let chosen: Vec<Effect> =
            (0..).zip(own).filter(|(i, _)| flags & 1 << i != 0).map(|e| e.1).collect();
        let effects = with(Effects::NONE, &chosen);
        let scatters = effects.has(Diffuse) || effects.has(Glossy);
        let spheres = effects.has(Factored) || effects.has(Anchored);
        if scatters && bounces == 0
            || !spheres && (scatters || effects.has(Interior))
            || effects.has(Hierarchy) && !effects.has(Factored)
        {
            continue;
        }
        let samples = match estimator {
            Explicit => effects.has(Diffuse),
            Mis => scatters,
            _ => false,
        };
        for lights in LIGHTS {
            let is_there = |light, form| !lights.contains(&light) || effects.has(form);
            if lights.is_empty() {
                sets.push(effects);
            } else if samples
                && is_there(Effect::FactoredLight, Factored)
                && is_there(Effect::AnchoredLight, Anchored)
            {
                sets.push(with(effects.with(Effect::Connections), lights));
            }
        }
    }
    sets
}

/// The forms of a few spheres that call for these effects: one or two, mixed, and as many as
/// are written out.
fn written(effects: Effects) -> Vec<Vec<Form>> {
    let forms = [(Effect::Factored, Form::Factored), (Effect::Anchored, Form::Anchored)];
    let there: Vec<Form> =
        forms.into_iter().filter(|form| effects.has(form.0)).map(|form| form.1).collect();
    let mixed = there.iter().chain(there.iter().rev()).copied().collect();
    let most = there.iter().cycle().take(16).copied().collect();
    vec![there, mixed, most]
}

/// Every kernel for a picture of 8 × 8 pixels.
fn kernels() -> Vec<Kernel> {
    let mut kernels = Vec::new();
    for (estimator, bounces) in Estimator::ALL.into_iter().flat_map(|e| BOUNCES.map(|b| (e, b))) {
        for effects in sets(estimator, bounces) {
            let looped = Kernel {
                size: ImageSize::new(8, 8).expect("a size"),
                bounces,
                estimator,
                effects,
                written: None,
                stored: true,
                light: 0,
                stack: 5,
            };
            if !effects.has(Effect::Hierarchy) {
                kernels.push(Kernel { stored: false, ..looped.clone() });
                // Many lights are more spheres than are written out, but not for the general
                // kernel of a scene with few.
                let few = |forms| Kernel { stored: false, written: Some(forms), ..looped.clone() };
                kernels.extend(written(effects).into_iter().map(few));
            }
            kernels.push(looped);
        }
    }
    kernels
}

/// Every block in a block, itself included.
fn each_block(block: &Block, see: &mut dyn FnMut(&Statement)) {
    for statement in block {
        see(statement);
        match statement {
            Statement::Block(inner) => each_block(inner, see),
            Statement::If { accept, reject, .. } => {
                each_block(accept, see);
                each_block(reject, see);
            }
            Statement::Switch { cases, .. } => {
                for case in cases {
                    each_block(&case.body, see);
                }
            }
            Statement::Loop { body, continuing, .. } => {
                each_block(body, see);
                each_block(continuing, see);
            }
            _ => {}
        }
    }
}

fn calls(function: &Function) -> Vec<Handle<Function>> {
    let mut calls = Vec::new();
    each_block(&function.body, &mut |statement| {
        if let Statement::Call { function, .. } = statement {
            calls.push(*function);
        }
    });
    calls
}

/// What is in a module but cannot be reached from its entry point: functions and variables.
fn unreachable(module: &Module) -> Vec<String> {
    let entry = &module.entry_points[0].function;
    let (mut functions, mut variables) = (BTreeSet::new(), BTreeSet::new());
    let mut open = vec![entry];
    while let Some(function) = open.pop() {
        variables.extend(function.expressions.iter().filter_map(
            |(_, expression)| match expression {
                Expression::GlobalVariable(variable) => Some(*variable),
                _ => None,
            },
        ));
        let new = calls(function).into_iter().filter(|&called| functions.insert(called));
        open.extend(new.collect::<Vec<_>>().into_iter().map(|called| &module.functions[called]));
    }
    let idle_functions = module.functions.iter().filter(|(handle, _)| !functions.contains(handle));
    let idle_variables =
        module.global_variables.iter().filter(|(handle, _)| !variables.contains(handle));
    let names = idle_functions.map(|idle| idle.1.name.clone());
    names.chain(idle_variables.map(|idle| idle.1.name.clone())).flatten().collect()
}

fn has_function(module: &Module, name: &str) -> bool {
    module.functions.iter().any(|(_, function)| function.name.as_deref() == Some(name))
}

/// Loops in the function that follows a path and in what it calls.
fn loops(module: &Module) -> usize {
    let follows = |(_, function): &(_, &Function)| function.name.as_deref() == Some("trace");
    let mut open: Vec<&Function> =
        module.functions.iter().find(follows).map(|f| f.1).into_iter().collect();
    let mut loops = 0;
    while let Some(function) = open.pop() {
        each_block(&function.body, &mut |statement| {
            loops += usize::from(matches!(statement, Statement::Loop { .. }));
        });
        open.extend(calls(function).into_iter().map(|called| &module.functions[called]));
    }
    loops
}

type CalledFor = fn(&Kernel) -> bool;

/// Functions, and when they are in the kernel that renders.
const BROUGHT: &[(&[&str], CalledFor)] = &[
    (
        &[
            "polar_phong",
            "mirror_direction",
            "weight_glossy",
            "density_drawn",
            "minus_log_complement",
        ],
        |kernel| kernel.effects.has(Effect::Glossy),
    ),
    (&["evaluate_glossy", "exp_minus"], |kernel| {
        kernel.estimator == Mis
            && kernel.effects.has(Effect::Glossy)
            && kernel.effects.has(Effect::Connections)
    }),
    (&["polar_diffuse", "weight_diffuse"], |kernel| kernel.effects.has(Effect::Diffuse)),
    (&["scatter", "surface_point", "around", "facing_normal"], |kernel| scatters(kernel)),
    (&["factored"], |kernel| kernel.effects.has(Effect::Factored)),
    (&["anchored"], |kernel| kernel.effects.has(Effect::Anchored)),
    (&["closer_factored"], |kernel| searches(kernel, Effect::Factored)),
    (&["closer_anchored"], |kernel| searches(kernel, Effect::Anchored)),
    (&["nearest_anchored"], |kernel| {
        kernel.written.is_none() && kernel.effects.has(Effect::Anchored)
    }),
    (&["exit"], |kernel| kernel.effects.has(Effect::Interior)),
    (&["nearest_hierarchy", "climber", "descend"], |kernel| kernel.effects.has(Effect::Hierarchy)),
    (
        &["connect", "pick_light", "cone_of", "cone_from", "polar_cone", "occluded", "evaluate"],
        |kernel| kernel.effects.has(Effect::Connections),
    ),
    (&["occluded_hierarchy"], |kernel| {
        kernel.effects.has(Effect::Hierarchy) && kernel.effects.has(Effect::Connections)
    }),
    (&["occluded_anchored"], |kernel| {
        kernel.written.is_none()
            && kernel.effects.has(Effect::Anchored)
            && kernel.effects.has(Effect::Connections)
    }),
    (&["scan_for_light", "light_at"], |kernel| kernel.effects.has(Effect::LightScan)),
    (&["walk_to", "node_potential"], |kernel| kernel.effects.has(Effect::LightTree)),
    (&["cone_anchored"], |kernel| kernel.effects.has(Effect::AnchoredLight)),
    (&["cone_factored"], |kernel| {
        kernel.effects.has(Effect::FactoredLight) || kernel.effects.has(Effect::LightTree)
    }),
    (&["load_shapes"], |kernel| kernel.written.is_some()),
];

fn scatters(kernel: &Kernel) -> bool {
    kernel.effects.has(Effect::Diffuse) || kernel.effects.has(Effect::Glossy)
}

/// Whether all spheres of a form are looked at one by one: those under a hierarchy are not.
fn searches(kernel: &Kernel, form: Effect) -> bool {
    let under = form == Effect::Factored
        && kernel.effects.has(Effect::Hierarchy)
        && !kernel.effects.has(Effect::Interior);
    kernel.effects.has(form) && !under
}

/// What is wrong with the text of a kernel.
fn faults(kernel: &Kernel, text: &str) -> Vec<String> {
    let module = match validate(text) {
        Ok((module, _)) => module,
        Err(message) => return vec![message],
    };
    let mut faults = unreachable(&module);
    for (names, is_called_for) in BROUGHT {
        let expected = is_called_for(kernel);
        let wrong = names.iter().filter(|name| has_function(&module, name) != expected);
        faults.extend(wrong.map(|name| format!("{name} is there: {}", !expected)));
    }
    if kernel.written.is_some() && !scatters(kernel) && loops(&module) > 0 {
        faults.push("a loop where a path has one segment".to_owned());
    }
    faults
}

#[test]
fn kernels_hold_what_is_called_for_and_nothing_else() {
    let kernels = kernels();
    let wrong: Vec<String> = kernels
        .par_iter()
        .filter_map(|kernel| {
            let faults = faults(kernel, &kernel.wgsl());
            (!faults.is_empty()).then(|| format!("{kernel:?}: {faults:?}"))
        })
        .collect();
    println!("{} kernels", kernels.len());
    assert!(wrong.is_empty(), "{} of {} kernels, {}", wrong.len(), kernels.len(), wrong[0]);
    assert!(kernels.len() > 2000);
}

#[test]
fn every_kernel_that_replays_is_valid() {
    kernels().par_iter().for_each(|kernel| {
        if let Err(message) = validate(&kernel.replay_wgsl()) {
            panic!("{kernel:?}: {message}");
        }
    });
}

#[test]
fn kernels_of_all_sizes_are_valid() {
    let sides = [1, 2, 3, 5, 64];
    let kernel = &kernels()[0];
    for (width, height) in sides.iter().flat_map(|&w| sides.map(|h| (w, h))) {
        let size = ImageSize::new(width, height).expect("a size");
        let tile = Tile::of(size);
        assert_eq!(tile.width * tile.height * tile.samples, Tile::INVOCATIONS, "{tile:?}");
        validate(&Kernel { size, ..kernel.clone() }.wgsl()).expect("a valid kernel");
    }
}

/// A chalk-only kernel under `mis`, with the loops of a scene of medium size.
fn chalk() -> Kernel {
    let wanted = |kernel: &Kernel| {
        kernel.effects.has(Effect::Connections)
            && !kernel.effects.has(Effect::Glossy)
            && kernel.estimator == Mis
            && kernel.written.is_none()
    };
    kernels().into_iter().find(wanted).expect("one of them")
}

/// The text with `to` in place of `from`, which is there once.
fn changed(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    text.replace(from, to)
}

#[test]
fn what_is_not_called_for_is_told() {
    let (kernel, text) = (chalk(), chalk().wgsl());
    assert_eq!(faults(&kernel, &text), Vec::<String>::new());
    let idle = format!("{text}\nfn idle(x: f32) -> f32 {{ return x; }}\n");
    assert_eq!(faults(&kernel, &idle), ["idle"]);
    let idle = format!("{text}\nvar<private> idle: f32;\n");
    assert_eq!(faults(&kernel, &idle), ["idle"]);
    // Two that only call one another.
    let idle =
        "\nfn idle(x: f32) -> f32 { return x; }\nfn more(x: f32) -> f32 { return idle(x); }\n";
    assert_eq!(faults(&kernel, &format!("{text}{idle}")), ["idle", "more"]);
    // The lobe, called where it cannot matter.
    let from = "let polar = polar_diffuse(u.x);";
    let called =
        changed(&text, from, "let polar = polar_diffuse(u.x) + 0.0 * polar_phong(u.x, 1.0);");
    let lobe = include_str!("../shaders/lobe.wgsl");
    let exponential = include_str!("../shaders/exponential.wgsl");
    let found = faults(&kernel, &format!("{called}\n{exponential}\n{lobe}"));
    assert!(found.contains(&"polar_phong is there: true".to_owned()), "{found:?}");
    // A kernel without what its scene calls for.
    let blind = Kernel { effects: kernel.effects.with(Effect::Glossy), ..kernel };
    assert!(faults(&blind, &text).contains(&"polar_phong is there: false".to_owned()));
}

#[test]
fn a_loop_over_bounces_is_told() {
    let wanted = |kernel: &Kernel| kernel.written.is_some() && kernel.bounces == 0;
    let kernel = kernels().into_iter().find(wanted).expect("one of them");
    let text = kernel.wgsl();
    assert_eq!(faults(&kernel, &text), Vec::<String>::new());
    let looped = changed(&text, "    if goes_on {\n", "    while goes_on {\n");
    assert_eq!(faults(&kernel, &looped), ["a loop where a path has one segment"]);
}
