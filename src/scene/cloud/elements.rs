//! The chemical elements: how large an atom is drawn, and in which colour.
//!
//! Van der Waals radii of the main group: M. Mantina, A. C. Chamberlin, R. Valero, C. J. Cramer and
//! D. G. Truhlar, J. Phys. Chem. A 113, 5806 (2009), table 12, which holds those of A. Bondi, J.
//! Phys. Chem. 68, 441 (1964), hydrogen's of R. S. Rowland and R. Taylor, J. Phys. Chem. 100, 7384
//! (1996), and its authors' own. Of the transition metals, lanthanides and actinides: S. Alvarez,
//! Dalton Trans. 42, 8617 (2013), table 1. Neither has one for promethium, nor for anything beyond
//! einsteinium.
//!
//! Colours: those of Jmol (<https://jmol.sourceforge.net/jscolors/>, "Jmol colors"), which follow
//! the models of Corey, Pauling and Koltun where those have a colour. They are for screens, and so
//! in sRGB (IEC 61966-2-1).

use glam::DVec3;

use crate::scene::Albedo;

/// What the table holds, for messages.
pub(super) const KNOWN: &str = "a symbol or an atomic number from H, 1, to Es, 99, without Pm, 61; \
                                D and T are hydrogen";

/// An element as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Element {
    /// Van der Waals radius in ångström.
    pub(super) radius: f64,
    /// sRGB, 8 bits each.
    colour: [u8; 3],
}

impl Element {
    /// The colour as linear albedo with Rec. 709 primaries.
    pub(super) fn albedo(self) -> Albedo {
        Albedo::new(DVec3::from_array(self.colour.map(linear)))
            .expect("the curve maps a byte to a number from 0 to 1")
    }
}

/// IEC 61966-2-1, from 8 bits of sRGB to linear.
fn linear(byte: u8) -> f64 {
    let x = f64::from(byte) / 255.0;
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// The element with a symbol, in capitals or not, or an atomic number.
pub(super) fn named(name: &str) -> Option<Element> {
    let by_number = |number: u8| ELEMENTS.iter().find(|element| element.0 == number);
    let found = match name.parse() {
        Ok(number) => by_number(number),
        Err(_) if ["D", "T"].iter().any(|isotope| isotope.eq_ignore_ascii_case(name)) => {
            by_number(1)
        }
        Err(_) => ELEMENTS.iter().find(|element| element.1.eq_ignore_ascii_case(name)),
    };
    found.map(|&(_, _, radius, colour)| Element { radius, colour })
}

/// Atomic number, symbol, van der Waals radius in ångström, colour in sRGB.
const ELEMENTS: [(u8, &str, f64, [u8; 3]); 98] = [
    (1, "H", 1.10, [0xFF, 0xFF, 0xFF]),
    (2, "He", 1.40, [0xD9, 0xFF, 0xFF]),
    (3, "Li", 1.81, [0xCC, 0x80, 0xFF]),
    (4, "Be", 1.53, [0xC2, 0xFF, 0x00]),
    (5, "B", 1.92, [0xFF, 0xB5, 0xB5]),
    (6, "C", 1.70, [0x90, 0x90, 0x90]),
    (7, "N", 1.55, [0x30, 0x50, 0xF8]),
    (8, "O", 1.52, [0xFF, 0x0D, 0x0D]),
    (9, "F", 1.47, [0x90, 0xE0, 0x50]),
    (10, "Ne", 1.54, [0xB3, 0xE3, 0xF5]),
    (11, "Na", 2.27, [0xAB, 0x5C, 0xF2]),
    (12, "Mg", 1.73, [0x8A, 0xFF, 0x00]),
    (13, "Al", 1.84, [0xBF, 0xA6, 0xA6]),
    (14, "Si", 2.10, [0xF0, 0xC8, 0xA0]),
    (15, "P", 1.80, [0xFF, 0x80, 0x00]),
    (16, "S", 1.80, [0xFF, 0xFF, 0x30]),
    (17, "Cl", 1.75, [0x1F, 0xF0, 0x1F]),
    (18, "Ar", 1.88, [0x80, 0xD1, 0xE3]),
    (19, "K", 2.75, [0x8F, 0x40, 0xD4]),
    (20, "Ca", 2.31, [0x3D, 0xFF, 0x00]),
    (21, "Sc", 2.58, [0xE6, 0xE6, 0xE6]),
    (22, "Ti", 2.46, [0xBF, 0xC2, 0xC7]),
    (23, "V", 2.42, [0xA6, 0xA6, 0xAB]),
    (24, "Cr", 2.45, [0x8A, 0x99, 0xC7]),
    (25, "Mn", 2.45, [0x9C, 0x7A, 0xC7]),
    (26, "Fe", 2.44, [0xE0, 0x66, 0x33]),
    (27, "Co", 2.40, [0xF0, 0x90, 0xA0]),
    (28, "Ni", 2.40, [0x50, 0xD0, 0x50]),
    (29, "Cu", 2.38, [0xC8, 0x80, 0x33]),
    (30, "Zn", 2.39, [0x7D, 0x80, 0xB0]),
    (31, "Ga", 1.87, [0xC2, 0x8F, 0x8F]),
    (32, "Ge", 2.11, [0x66, 0x8F, 0x8F]),
    (33, "As", 1.85, [0xBD, 0x80, 0xE3]),
    (34, "Se", 1.90, [0xFF, 0xA1, 0x00]),
    (35, "Br", 1.83, [0xA6, 0x29, 0x29]),
    (36, "Kr", 2.02, [0x5C, 0xB8, 0xD1]),
    (37, "Rb", 3.03, [0x70, 0x2E, 0xB0]),
    (38, "Sr", 2.49, [0x00, 0xFF, 0x00]),
    (39, "Y", 2.75, [0x94, 0xFF, 0xFF]),
    (40, "Zr", 2.52, [0x94, 0xE0, 0xE0]),
    (41, "Nb", 2.56, [0x73, 0xC2, 0xC9]),
    (42, "Mo", 2.45, [0x54, 0xB5, 0xB5]),
    (43, "Tc", 2.44, [0x3B, 0x9E, 0x9E]),
    (44, "Ru", 2.46, [0x24, 0x8F, 0x8F]),
    (45, "Rh", 2.44, [0x0A, 0x7D, 0x8C]),
    (46, "Pd", 2.15, [0x00, 0x69, 0x85]),
    (47, "Ag", 2.53, [0xC0, 0xC0, 0xC0]),
    (48, "Cd", 2.49, [0xFF, 0xD9, 0x8F]),
    (49, "In", 1.93, [0xA6, 0x75, 0x73]),
    (50, "Sn", 2.17, [0x66, 0x80, 0x80]),
    (51, "Sb", 2.06, [0x9E, 0x63, 0xB5]),
    (52, "Te", 2.06, [0xD4, 0x7A, 0x00]),
    (53, "I", 1.98, [0x94, 0x00, 0x94]),
    (54, "Xe", 2.16, [0x42, 0x9E, 0xB0]),
    (55, "Cs", 3.43, [0x57, 0x17, 0x8F]),
    (56, "Ba", 2.68, [0x00, 0xC9, 0x00]),
    (57, "La", 2.98, [0x70, 0xD4, 0xFF]),
    (58, "Ce", 2.88, [0xFF, 0xFF, 0xC7]),
    (59, "Pr", 2.92, [0xD9, 0xFF, 0xC7]),
    (60, "Nd", 2.95, [0xC7, 0xFF, 0xC7]),
    (62, "Sm", 2.90, [0x8F, 0xFF, 0xC7]),
    (63, "Eu", 2.87, [0x61, 0xFF, 0xC7]),
    (64, "Gd", 2.83, [0x45, 0xFF, 0xC7]),
    (65, "Tb", 2.79, [0x30, 0xFF, 0xC7]),
    (66, "Dy", 2.87, [0x1F, 0xFF, 0xC7]),
    (67, "Ho", 2.81, [0x00, 0xFF, 0x9C]),
    (68, "Er", 2.83, [0x00, 0xE6, 0x75]),
    (69, "Tm", 2.79, [0x00, 0xD4, 0x52]),
    (70, "Yb", 2.80, [0x00, 0xBF, 0x38]),
    (71, "Lu", 2.74, [0x00, 0xAB, 0x24]),
    (72, "Hf", 2.63, [0x4D, 0xC2, 0xFF]),
    (73, "Ta", 2.53, [0x4D, 0xA6, 0xFF]),
    (74, "W", 2.57, [0x21, 0x94, 0xD6]),
    (75, "Re", 2.49, [0x26, 0x7D, 0xAB]),
    (76, "Os", 2.48, [0x26, 0x66, 0x96]),
    (77, "Ir", 2.41, [0x17, 0x54, 0x87]),
    (78, "Pt", 2.29, [0xD0, 0xD0, 0xE0]),
    (79, "Au", 2.32, [0xFF, 0xD1, 0x23]),
    (80, "Hg", 2.45, [0xB8, 0xB8, 0xD0]),
    (81, "Tl", 1.96, [0xA6, 0x54, 0x4D]),
    (82, "Pb", 2.02, [0x57, 0x59, 0x61]),
    (83, "Bi", 2.07, [0x9E, 0x4F, 0xB5]),
    (84, "Po", 1.97, [0xAB, 0x5C, 0x00]),
    (85, "At", 2.02, [0x75, 0x4F, 0x45]),
    (86, "Rn", 2.20, [0x42, 0x82, 0x96]),
    (87, "Fr", 3.48, [0x42, 0x00, 0x66]),
    (88, "Ra", 2.83, [0x00, 0x7D, 0x00]),
    (89, "Ac", 2.80, [0x70, 0xAB, 0xFA]),
    (90, "Th", 2.93, [0x00, 0xBA, 0xFF]),
    (91, "Pa", 2.88, [0x00, 0xA1, 0xFF]),
    (92, "U", 2.71, [0x00, 0x8F, 0xFF]),
    (93, "Np", 2.82, [0x00, 0x80, 0xFF]),
    (94, "Pu", 2.81, [0x00, 0x6B, 0xFF]),
    (95, "Am", 2.83, [0x54, 0x5C, 0xF2]),
    (96, "Cm", 3.05, [0x78, 0x5C, 0xE3]),
    (97, "Bk", 3.40, [0x8A, 0x4F, 0xE3]),
    (98, "Cf", 3.05, [0xA1, 0x36, 0xD4]),
    (99, "Es", 2.70, [0xB3, 0x1F, 0xD4]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_go_by_symbol_or_number() {
        let carbon = named("C").expect("carbon");
        assert_eq!((carbon.radius, carbon.colour), (1.70, [0x90; 3]));
        assert_eq!(named("6"), Some(carbon));
        assert_eq!(named("c"), Some(carbon));
        assert_eq!(named("CL"), named("Cl"));
        assert_eq!(named("D"), named("H"));
        for unknown in ["", "0", "61", "Pm", "100", "Fm", "X", "C1", "-1", "256", "é"] {
            assert_eq!(named(unknown), None, "{unknown}");
        }
    }

    /// Atomic numbers count up, no symbol is there twice, and only promethium is left out.
    #[test]
    fn the_table_is_in_order() {
        let numbers: Vec<u8> = ELEMENTS.iter().map(|element| element.0).collect();
        assert!(numbers.iter().copied().eq((1..=99).filter(|&number| number != 61)));
        for (index, element) in ELEMENTS.iter().enumerate() {
            assert!(ELEMENTS[..index].iter().all(|other| other.1 != element.1), "{element:?}");
            assert!((1.0..3.5).contains(&element.2), "{element:?}");
        }
    }

    /// The two ends of the curve, its joint, and the middle grey of sRGB, 0.2140 (IEC 61966-2-1).
    #[test]
    fn colours_become_linear() {
        assert_eq!(linear(0).to_bits(), 0.0_f64.to_bits());
        assert_eq!(linear(255).to_bits(), 1.0_f64.to_bits());
        assert!((linear(10) - 10.0 / 255.0 / 12.92).abs() < 1e-15);
        assert!((linear(11) - 0.003_346_5).abs() < 1e-7);
        assert!((linear(127) - 0.212_230_8).abs() < 1e-7);
    }
}
