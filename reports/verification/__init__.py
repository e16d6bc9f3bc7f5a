"""Is an acceptance document what it says?"""
