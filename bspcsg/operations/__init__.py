"""Operations on several solids, or on the parts of one."""
