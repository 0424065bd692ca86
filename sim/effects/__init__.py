"""Physical effects a simulation may lack: one file each, with units, sign bounds and the trace each leaves."""
