// A picture's numbers, from the worker to the page, in one Float32Array: header, effectors, trace.
export const kHeader = 8; // time [s], duration of a tick [us], speed [1], rows of the trace, recorded
// rows, a hand moves an effector, the module's memory [bytes]
export const kEffector = 16; // position 3 [m], force 3 [N], normal 3, depth [m], touching, object, ready, normal
                             // force [N], drawn
export const kTraceRows = 512;
export const kTraceRow = 3; // effector, depth [m], normal force [N]: of every tick in contact
export const traceAt = (effectors) => kHeader + kEffector * effectors;
