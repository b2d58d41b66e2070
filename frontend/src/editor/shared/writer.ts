/** Edits written into the shared Yjs document, inside whatever transaction there is. */
import * as Y from "yjs";
import type { Edit } from "../edits/edits";
import type { Step } from "@/program/document/document";

export function writeEdit(doc: Y.Doc, edit: Edit): void {
  const steps = doc.getMap<Y.Map<unknown>>("steps");
  switch (edit.do) {
    case "add_step":
      steps.set(edit.id, sharedStep(edit.step));
      return;
    case "remove_step":
      steps.delete(edit.id);
      return;
    case "set_place":
      steps.get(edit.id)?.set("place", edit.place);
      return;
    case "set_pos":
      steps.get(edit.id)?.set("pos", edit.pos);
      return;
    case "set_param":
      setOrDelete(paramsOf(steps.get(edit.id)), edit.name, edit.value);
      return;
    case "set_function":
      setOrDelete(doc.getMap("functions"), edit.id, edit.value);
      return;
    case "set_role":
      setOrDelete(doc.getMap("roles"), edit.id, edit.value);
      return;
    case "set_parameter":
      setOrDelete(doc.getMap("parameters"), edit.id, edit.value);
      return;
    case "set_zone":
      setOrDelete(doc.getMap("zones"), edit.id, edit.value);
      return;
    case "set_start":
      doc.getMap("meta").set("start_pos", edit.pos);
  }
}

function sharedStep(step: Step): Y.Map<unknown> {
  const shared = new Y.Map<unknown>();
  shared.set("kind", step.kind);
  shared.set("place", step.place ?? null);
  shared.set("pos", step.pos ?? null);
  shared.set("params", new Y.Map(Object.entries(step.params)));
  return shared;
}

function paramsOf(step: Y.Map<unknown> | undefined): Y.Map<unknown> | null {
  const params = step?.get("params");
  return params instanceof Y.Map ? params : null;
}

function setOrDelete(map: Y.Map<unknown> | null, name: string, value: unknown): void {
  if (!map) return;
  if (value === null || value === undefined) map.delete(name);
  else map.set(name, value);
}
