// WebHID: opens a device on the page's side and carries its reports to and from the worker, where the native drivers
// read them (devices/drivers/web/hid.cpp).
const kDevices = [
  { vendorId: 0x054c, driver: 'dualsense', products: [0x0ce6, 0x0df2], features: [0x05, 0x20] },
  { vendorId: 0x054c, driver: 'dualshock4', products: [0x05c4, 0x09cc, 0x0ba0], features: [0x02, 0x05] },
  { vendorId: 0x256f, driver: 'spacemouse' },
  {
    vendorId: 0x046d,
    driver: 'spacemouse',
    products: [0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625, 0xc626, 0xc627, 0xc628, 0xc629, 0xc62b],
  },
];

export const available = () => 'hid' in navigator;

// Asks for a device, which needs a click. `ask(act, more)` writes to the worker. Null: none was chosen.
export async function connect(ask, number) {
  const filters = kDevices.flatMap(({ vendorId, products }) =>
    products ? products.map((productId) => ({ vendorId, productId })) : [{ vendorId }],
  );
  const [device] = await navigator.hid.requestDevice({ filters });
  if (!device) return null;
  const kind = kDevices.find(
    (each) => each.vendorId === device.vendorId && (!each.products || each.products.includes(device.productId)),
  );
  if (!device.opened) await device.open();
  const features = [];
  for (const report of kind.features ?? [])
    try {
      features.push([report, new Uint8Array((await device.receiveFeatureReport(report)).buffer)]);
    } catch {
      /* the device has no such report on this line */
    }
  ask('plug', {
    number,
    driver: kind.driver,
    vendor: device.vendorId,
    product: device.productId,
    name: device.productName,
    descriptor: descriptor(device.collections),
    features,
  });
  device.addEventListener('inputreport', ({ reportId, data }) => {
    const bytes = new Uint8Array(1 + data.byteLength);
    bytes[0] = reportId;
    bytes.set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength), 1);
    ask('report', { number, bytes: reportId ? bytes : bytes.subarray(1) });
  });
  navigator.hid.addEventListener('disconnect', (event) => event.device === device && ask('unplug', { number }));
  return device;
}

// A HID report descriptor with the fields that the browser has parsed from the device's own (USB HID 1.11, 6.2.2).
export function descriptor(collections) {
  const out = [];
  const item = (tag, value, signed = false) => {
    const size = signed
      ? value >= -128 && value < 128
        ? 1
        : value >= -32768 && value < 32768
          ? 2
          : 4
      : value < 256
        ? 1
        : value < 65536
          ? 2
          : 4;
    out.push(tag | (size === 4 ? 3 : size));
    for (let i = 0; i < size; ++i) out.push((value >> (8 * i)) & 255);
  };
  for (const { usagePage, usage, inputReports = [], outputReports = [], featureReports = [] } of collections) {
    (item(0x04, usagePage), item(0x08, usage), item(0xa0, 1));
    for (const [reports, tag] of [
      [inputReports, 0x80],
      [outputReports, 0x90],
      [featureReports, 0xb0],
    ])
      for (const { reportId, items = [] } of reports) {
        if (reportId) item(0x84, reportId);
        for (const each of items) {
          const usages = each.isRange ? [] : (each.usages ?? []);
          const page = each.isRange ? each.usageMinimum >>> 16 : (usages[0] ?? 0) >>> 16;
          if (page) item(0x04, page);
          if (each.isRange) (item(0x18, each.usageMinimum & 0xffff), item(0x28, each.usageMaximum & 0xffff));
          else for (const use of usages) item(0x08, use & 0xffff);
          (item(0x14, each.logicalMinimum, true), item(0x24, each.logicalMaximum, true));
          (item(0x74, each.reportSize), item(0x94, each.reportCount));
          item(tag, (each.isConstant ? 1 : 0) | (each.isArray ? 0 : 2) | (each.isAbsolute ? 0 : 4));
        }
      }
    out.push(0xc0);
  }
  return new Uint8Array(out);
}
