//! What the agreement tests do not see: names and places of slots, and how much comes out.
