/** What has been tried in this browser, for the steps of the demo's card. */
const KEPT_AS = "vipo.begun";
const VISITS: readonly [name: Tried, address: RegExp][] = [
  ["map", /^\/sites\/[^/]+\/map$/],
  ["simulate", /^\/programs\/[^/]+\/simulate\/.+/],
];

export type Tried = "map" | "simulate" | "hidden";

export function hasTried(what: Tried): boolean {
  return (localStorage.getItem(KEPT_AS) ?? "").split(" ").includes(what);
}

export function markTried(what: Tried): void {
  if (!hasTried(what)) localStorage.setItem(KEPT_AS, `${localStorage.getItem(KEPT_AS) ?? ""} ${what}`.trim());
}

/** Note a visit, if the address is one of those that count. */
export function noteVisit(pathname: string): void {
  for (const [name, address] of VISITS) if (address.test(pathname)) markTried(name);
}
