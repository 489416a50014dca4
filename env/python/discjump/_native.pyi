# Written by hand (generated stubs lose numpy's types) and checked against the binary by mypy.stubtest.
