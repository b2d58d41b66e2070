/** The place where the next step goes: chosen at an open branch, and said in words. */
import { toPixels, type Point } from "@/map/plane/projection";
import { isCatch } from "@/program/document/catches";
import { branchesOf, type BranchRef } from "@/program/document/tree";
import { branchWord, type Link, offersBranch } from "@/program/scene/links";
import type { OpenProgram } from "./context";
import { useUi } from "./ui";

type Told = Pick<OpenProgram, "document" | "t">;

/** Drawing pixels around an open branch's end that belong to it: nothing that stands there is taken for its step. */
const REACH = 34;

/** "If 2, “true”"; null for the program itself, where steps go anyhow. */
export function placeWords({ document, compiled, t }: OpenProgram, { parent, branch }: BranchRef): string | null {
  const definition = document.functions[parent];
  if (definition) return t("place.function", { name: definition.name });
  const step = document.steps[parent];
  if (!step) return null;
  const said = { kind: t(`kind.${step.kind}`), number: compiled?.numbers[parent] ?? "", word: "" };
  if (branch === "body") return t("place.inside", said);
  return t("place.branch", { ...said, word: branchWord(branch, step, t) });
}

/** "draw here what is done when …", beside a branch that has no step yet. */
export function invitation({ document, t }: Told, { parent, branch }: BranchRef): string {
  const kind = document.steps[parent]?.kind ?? "";
  if (isCatch(branch)) return t("target.catch");
  if (kind === "parallel") return t("target.beside", { branch });
  return t(branch === "body" ? `target.body_${kind}` : `target.${branch}`, { defaultValue: t("target.body") });
}

/** The open branch whose end is at a point of the floor. */
export function openBranchAt(links: readonly Link[], at: Point): Link | null {
  const point = toPixels(at);
  const far = ({ points }: Link) => {
    const end = points.at(-1);
    return end ? Math.hypot(end.x - point.x, end.y - point.y) : Infinity;
  };
  const near = links.filter((link) => link.to === null && far(link) <= REACH);
  return near.sort((one, other) => far(one) - far(other))[0] ?? null;
}

export function chooseBranch({ t }: Told, link: Link): void {
  useUi.setState({ into: { branch: link.into, link: link.id, word: link.word ?? t("then") } });
}

/**
 * Choose the branch of the selected step that comes after the one that is chosen, or before it: those that have no step
 * yet come first. False where the step has none.
 */
export function chooseNextBranch(open: Pick<OpenProgram, "document" | "scene" | "t">, by: 1 | -1): boolean {
  const { selected, into } = useUi.getState();
  const [parent, second] = selected;
  const step = parent === undefined || second !== undefined ? undefined : open.document.steps[parent];
  if (parent === undefined || !step) return false;
  const branches = placesOf(open, parent);
  const at = into?.branch.parent === parent ? branches.indexOf(into.branch.branch) : -1;
  const next = branches[at < 0 ? (by > 0 ? 0 : branches.length - 1) : (at + by + branches.length) % branches.length];
  if (next === undefined) return false;
  const word = branchWord(next, step, open.t) || open.t(`kind.${step.kind}`);
  useUi.setState({ into: { branch: { parent, branch: next }, link: `${parent}/${next}`, word } });
  return true;
}

/** The branches that a step can be drawn into, the open ones first. */
function placesOf({ document, scene }: Pick<OpenProgram, "document" | "scene">, parent: string): readonly string[] {
  const step = document.steps[parent];
  const isOpen = (branch: string) => scene.tree.children(parent, branch).length === 0;
  const can = (step ? branchesOf(step) : []).filter(
    (branch) => !isOpen(branch) || branch === "body" || offersBranch(document, { parent, branch }),
  );
  return [...can.filter(isOpen), ...can.filter((branch) => !isOpen(branch))];
}
