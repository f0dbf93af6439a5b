// Writes a result again with names that would run, were they not text: hostile.mjs RESULT OUT.
import { readFile, writeFile } from "node:fs/promises";

const HOSTILE = `</script><script>window.hacked=1</script><img src=x onerror="window.hacked=1">'"&`;
const [from, to] = process.argv.slice(2);
const report = JSON.parse(await readFile(from, "utf8"));
const name = report.adapters[0].name;
for (const adapter of report.adapters) Object.assign(adapter, { name: HOSTILE, device: HOSTILE, driver: HOSTILE });
for (const one of [...report.groups, ...report.failures, ...report.deviations]) if (one.adapter === name) one.adapter = HOSTILE;
for (const group of report.groups) {
  for (const one of group.diagnosis?.explanations ?? []) one.says = HOSTILE;
  for (const one of group.problems ?? []) one.says += HOSTILE;
  if (group.skip_reason) group.skip_reason += HOSTILE;
}
for (const failure of report.failures) {
  failure.output = HOSTILE;
  failure.rerun = HOSTILE;
  failure.inputs = { [HOSTILE]: HOSTILE, ...failure.inputs };
}
for (const one of report.explained) Object.assign(one, { formula: HOSTILE, source: HOSTILE });
report.command = HOSTILE;
report.regressions = [HOSTILE];
report.mended = [HOSTILE];
// A great integer is read as a count that cannot be.
const spelt = (key, value) => (typeof value === "number" && value > 2 ** 48 ? 1e300 : value);
await writeFile(to, JSON.stringify(report, spelt));
