/** What several steps are told alike: the fields that all of them have, and one value for all. Pure. */
import type { Step } from "@/program/document/document";
import { isSameValue } from "@/program/document/sameValue";
import { type FieldRecord, fieldsOf } from "@/program/kinds";
import type { Edit } from "./edits";

export interface CommonField {
  readonly field: FieldRecord;
  /** The value of all; undefined where none is given, or where they differ. */
  readonly value: unknown;
  readonly mixed: boolean;
}

/** Fields of the same name, type and meaning in every one of the steps, in the order of the first. */
export function commonFields(steps: readonly Step[]): CommonField[] {
  const [first, ...others] = steps;
  if (!first) return [];
  return fieldsOf(first.kind)
    .filter((field, at, all) => all.findIndex(({ name }) => name === field.name) === at)
    .filter((field) => others.every((step) => fieldsOf(step.kind).some((each) => isAlike(each, field))))
    .map((field) => {
      const value = first.params[field.name];
      const mixed = others.some((step) => !isSameValue(step.params[field.name] ?? null, value ?? null));
      return { field, mixed, value: mixed ? undefined : value };
    });
}

function isAlike(one: FieldRecord, other: FieldRecord): boolean {
  return (
    one.name === other.name && one.type === other.type && one.wanted === other.wanted && one.accepts === other.accepts
  );
}

export function setForAll(ids: readonly string[], name: string, value: unknown): Edit[] {
  return ids.map((id) => ({ do: "set_param", id, name, value }));
}
