//! The methods of the traits that tell what a system is: names, degrees, what acts, what is held.

use proc_macro2::TokenStream;
use quote::quote;

use super::Printer;
use super::names::{ident, index};
use crate::plan::System;

impl Printer<'_> {
    /// What the system says of itself: its size, its names and the degrees of its functions.
    pub(super) fn facts(&self) -> TokenStream {
        let (plan, names) = (&self.plan.system, &self.plan.names);
        let n = index(self.plan.dimension());
        let (name, coordinates) = (&names.system, &names.coordinates);
        let of_h = degree("hamiltonian_degree", plan.hamiltonian_degree);
        let of_matrix = degree("poisson_degree", plan.poisson_degree);
        let casimirs = self.facts_of_casimirs();
        let driven = [
            ("is_almost_poisson", plan.almost_poisson),
            ("is_forced", plan.forced),
            ("force_mixes", plan.force_mixes),
            ("is_damped", plan.damped),
            ("is_metriplectic", plan.entropy.is_some()),
            ("is_autonomous", plan.clock.is_some() && plan.autonomous),
        ];
        let of_entropy = plan.entropy.and_then(|entropy| entropy.degree);
        let of_entropy = degree("entropy_degree", of_entropy);
        let driven = driven
            .into_iter()
            .filter(|(_, holds)| *holds)
            .map(|(name, _)| {
                let name = ident(name);
                quote! {
                    fn #name(&self) -> bool {
                        true
                    }
                }
            });
        let quantities = self.facts_of_quantities();
        let held = held(plan);
        let events = self.facts_of_events();
        let joints = (plan.joints > 0).then(|| {
            let count = index(plan.joints);
            quote! {
                fn joint_count(&self) -> usize {
                    #count
                }
            }
        });
        let clock = plan.clock.map(|clock| {
            let [momentum, time] = [clock.momentum, clock.time].map(index);
            quote! {
                fn clock(&self) -> ::core::option::Option<::lie_runtime::Clock> {
                    ::core::option::Option::Some(::lie_runtime::Clock {
                        momentum: #momentum,
                        time: #time,
                    })
                }
            }
        });
        quote! {
            fn dimension(&self) -> usize {
                #n
            }

            fn name(&self) -> &str {
                #name
            }

            fn coordinate(&self, index: usize) -> &str {
                [#(#coordinates),*][index]
            }

            #clock
            #joints
            #(#driven)*
            #of_entropy
            #casimirs
            #quantities
            #held
            #events
            #of_h
            #of_matrix
        }
    }

    fn facts_of_casimirs(&self) -> Option<TokenStream> {
        let casimirs = &self.plan.system.casimirs;
        if casimirs.is_empty() {
            return None;
        }
        let (count, names) = (index(casimirs.len()), casimirs.iter().map(|c| &c.name));
        let degrees = casimirs.iter().map(|c| option(c.degree));
        let multivalued = casimirs.iter().map(|c| c.multivalued);
        let multivalued = casimirs.iter().any(|c| c.multivalued).then(|| {
            quote! {
                fn casimir_is_multivalued(&self, index: usize) -> bool {
                    [#(#multivalued),*][index]
                }
            }
        });
        let kept = casimirs.iter().map(|c| c.kept);
        let kept = casimirs.iter().any(|c| !c.kept).then(|| {
            quote! {
                fn casimir_is_kept(&self, index: usize) -> bool {
                    [#(#kept),*][index]
                }
            }
        });
        Some(quote! {
            fn casimir_count(&self) -> usize {
                #count
            }

            fn casimir_name(&self, index: usize) -> &str {
                [#(#names),*][index]
            }

            fn casimir_degree(&self, index: usize) -> ::core::option::Option<u32> {
                [#(#degrees),*][index]
            }

            #multivalued
            #kept
        })
    }
}

/// What is set from outside.
fn held(plan: &System) -> Option<TokenStream> {
    if plan.inputs.is_empty() && plan.noises == 0 {
        return None;
    }
    let [inputs, noises] = [plan.inputs.len(), plan.noises].map(index);
    let samplings = plan.inputs.iter().map(|bits| match bits {
        Some(bits) => {
            let value = proc_macro2::Literal::f64_unsuffixed(f64::from_bits(*bits));
            quote! { ::core::option::Option::Some(#value) }
        }
        None => quote! { ::core::option::Option::None },
    });
    let sampling = plan.inputs.iter().any(Option::is_some).then(|| {
        quote! {
            fn input_sampling(&self, index: usize) -> ::core::option::Option<f64> {
                [#(#samplings),*][index]
            }
        }
    });
    let coin = (plan.noises > 1).then(|| {
        quote! {
            fn tosses_coin(&self) -> bool {
                true
            }
        }
    });
    Some(quote! {
        fn input_count(&self) -> usize {
            #inputs
        }

        #sampling

        fn noise_count(&self) -> usize {
            #noises
        }

        #coin
    })
}

fn option(degree: Option<u32>) -> TokenStream {
    match degree {
        Some(degree) => {
            let degree = index(degree as usize);
            quote! { ::core::option::Option::Some(#degree) }
        }
        None => quote! { ::core::option::Option::None },
    }
}

/// A method that gives a degree, where there is one.
fn degree(name: &str, degree: Option<u32>) -> Option<TokenStream> {
    degree?;
    let (name, degree) = (ident(name), option(degree));
    Some(quote! {
        fn #name(&self) -> ::core::option::Option<u32> {
            #degree
        }
    })
}
