"""Files of a block: reading with every finding named, and writing back in their convention."""
