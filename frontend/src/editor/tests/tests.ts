/** A program's tests: read, written, carried out; what changes comes with the site's live feed. */
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { create } from "zustand";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import { useOnce } from "@/api/once";
import type { ProgramTest, ProgramTests, Rehearsal, TestFault, TestRun, TestText, UnnoticedChange } from "@/api/types";
import type { TestRows } from "./testRows";
import type { TestValues } from "./testText";

/** What somebody writes and has not saved; a new test has no `id`, and no `tag` of what was read. */
export interface Draft {
  readonly id: string | null;
  readonly text: string;
  readonly tag: string;
}

/** What a form shows of a text, with the lines that lack something and so do not stand in it. */
export interface FilledForm {
  readonly text: string;
  readonly values: TestValues;
  readonly rows: TestRows;
}

export interface TestsUi {
  /** The test that is open, `new` for one that is not there yet. */
  readonly opened: string | null;
  /** By the ids of their tests, or `new`. They stay while the panel is closed. */
  readonly drafts: Readonly<Record<string, Draft>>;
  /** What is filled in, by the ids of their tests, or `new`. */
  readonly forms: Readonly<Record<string, FilledForm>>;
  /** What tests take is drawn on the map. */
  readonly marks: boolean;
  /** With so many seeds each test is carried out besides its own. */
  readonly seeds: number;
  /** Tests are written as text instead of in a form. */
  readonly asText: boolean;
  /** The panel is open, so its texts are here. */
  readonly shown: boolean;
}

/** What is asked to be carried out: all tests or some, on what is drawn or a version, how widely. */
export interface Asked {
  readonly tests?: readonly string[];
  readonly version?: number;
  readonly seeds?: number;
  readonly changes?: boolean;
}

export const NEW = "new";
const START: TestsUi = { opened: null, drafts: {}, forms: {}, marks: true, seeds: 0, asText: false, shown: false };
export const useTestsUi = create<TestsUi>(() => START);

/** Another program: nothing opened, nothing written. */
export function resetTests(): void {
  useTestsUi.setState({ opened: null, drafts: {}, forms: {} });
}

export function openTest(opened: string | null): void {
  useTestsUi.setState({ opened });
}

export function keepDraft(key: string, draft: Draft | null): void {
  useTestsUi.setState(({ drafts }) => {
    const others = Object.entries(drafts).filter(([each]) => each !== key);
    return { drafts: Object.fromEntries(draft ? [...others, [key, draft] as const] : others) };
  });
}

export function keepForm(key: string, form: FilledForm): void {
  useTestsUi.setState(({ forms }) => ({ forms: { ...forms, [key]: form } }));
}

/** What was filled in belongs to the test as it is saved now, with the lines that are not in its text yet. */
export function carryForm(from: string, written: string, made: TestText): void {
  const form = useTestsUi.getState().forms[from];
  if (form?.text === written) keepForm(made.id, { ...form, text: made.text });
}

const pathOf = (program: string) => `/programs/${program}`;
export const exportPath = (program: string) => `/api${pathOf(program)}/tests/file`;

export const useTests = (program: string) =>
  useQuery({
    queryKey: keys.tests(program),
    queryFn: () => api.get<ProgramTests>(`${pathOf(program)}/tests`),
    staleTime: 0,
  });

const textKey = (id: string | undefined, tag: string | undefined) => ["test-text", id, tag];

export const useTestText = (program: string, test: ProgramTest | undefined) =>
  useQuery({
    queryKey: textKey(test?.id, test?.tag),
    queryFn: () => api.get<TestText>(`${pathOf(program)}/tests/${test?.id}`),
    enabled: test !== undefined,
    staleTime: Infinity,
  });

/** How far tests are that were begun; the site's feed keeps it up to date. */
export const useTestProgress = (rehearsal: string | null) =>
  useQuery({
    queryKey: keys.rehearsal(rehearsal ?? ""),
    queryFn: () => api.get<Rehearsal>(`/rehearsals/${rehearsal}`),
    enabled: rehearsal !== null,
  });

/** What is wrong with a text, as the parser says it. */
export const lookAt = (program: string, text: string) =>
  api.post<{ fault: TestFault | null }>(`${pathOf(program)}/tests/look`, { text });

export const readTest = (program: string, id: string) => api.get<TestText>(`${pathOf(program)}/tests/${id}`);

/** What one does with a program's tests; all is read anew after each. */
export function useTesting(program: string) {
  const queries = useQueryClient();
  const begin = useOnce();
  const { mutateAsync, isPending } = useMutation({
    mutationFn: (act: () => Promise<unknown>) => act(),
    onSettled: () => queries.invalidateQueries({ queryKey: keys.tests(program) }),
  });
  const path = pathOf(program);
  const done = <T>(act: () => Promise<T>) => mutateAsync(act) as Promise<T>;
  const saved = (made: TestText) => {
    queries.setQueryData(textKey(made.id, made.tag), made);
    return made;
  };
  return {
    isPending,
    first: (of: "nothing" | "rehearsal") =>
      api.get<{ text: string; of_rehearsal: boolean }>(`${path}/tests/first?of=${of}`),
    add: (text: string) => done(() => api.post<TestText>(`${path}/tests`, { text }).then(saved)),
    write: (id: string, text: string, tag: string) =>
      done(() => api.put<TestText>(`${path}/tests/${id}`, { text }, tag).then(saved)),
    remove: (id: string, tag: string) => done(() => api.delete(`${path}/tests/${id}`, tag)),
    bringIn: (text: string) => done(() => api.post<TestText[]>(`${path}/tests/import`, { text })),
    run: (asked: Asked) => done(() => begin<TestRun>(`${path}/test-runs`, asked)),
    say: (change: UnnoticedChange, meant: boolean) => {
      const { step, code, name, mark } = change;
      return done(() => api.post(`${path}/tests/meant-changes`, { step, code, name, mark, meant }));
    },
    cancel: (rehearsal: string) => done(() => api.post(`/rehearsals/${rehearsal}/cancel`)),
  };
}
