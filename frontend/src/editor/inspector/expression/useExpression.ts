/** A line of text that stands for a value: read by the server as one types, stored when it means something. */
import { useDebouncedCallback } from "@mantine/hooks";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { api, ApiProblem } from "@/api/client";
import type { Value } from "@/program/document/document";
import type { FieldVisit } from "../../shared/fieldVisits";
import { useOpenProgram } from "../../state/context";
import { readPlain, type Wanted, writePlain } from "./literal";

const PAUSE_MS = 250;

export interface Expression {
  readonly text: string;
  /** Where the line cannot be understood, counted from 1. */
  readonly column: number | null;
  readonly problem: string | null;
  readonly write: (text: string) => void;
  /** Store at once what is written. */
  readonly settle: () => void;
  /** Store nothing of what is written. */
  readonly takeBack: () => void;
}

interface ExpressionInputs {
  readonly value: Value | undefined;
  readonly onChange: (value: Value) => void;
  readonly step: string;
  readonly wanted: Wanted;
}

interface Written {
  readonly text: string;
  readonly read: ReadExpression | null;
  readonly refusal: string | null;
}

const UNREAD = { read: null, refusal: null };

export function useExpression(inputs: ExpressionInputs): Expression {
  const { i18n, t } = useTranslation();
  const { written, write, store, forget } = useWritten(inputs);
  const later = useDebouncedCallback((text: string) => void store(text), { delay: PAUSE_MS, flushOnUnmount: true });
  const problem = written.read?.problem ?? null;
  const message = problem && (problem.messages[i18n.language] ?? problem.message);
  return {
    text: written.text,
    column: problem?.column ?? null,
    problem: written.refusal ?? (problem && t("expression.column", { column: problem.column, message })),
    write: (text) => {
      write(text);
      later(text);
    },
    settle: () => later.flush(),
    takeBack: () => {
      later.cancel();
      forget();
    },
  };
}

/** The line as it stands in the field; a value that comes from outside takes its place unless somebody types. */
function useWritten({ value, onChange, step, wanted }: ExpressionInputs) {
  const { program, shared } = useOpenProgram();
  const key = JSON.stringify(value ?? null);
  const plain = writePlain(value, wanted);
  const [written, setWritten] = useState<Written>({ text: plain ?? "", ...UNREAD });
  const turn = useRef(0);
  const typing = useRef(false);
  const visit = useRef<FieldVisit | null>(null);
  const known = useRef(plain === null ? "" : key);
  const change = useLatest(onChange);

  useEffect(() => {
    if (known.current === key) return;
    known.current = key;
    if (typing.current) return;
    const mine = ++turn.current;
    if (plain !== null) {
      setWritten({ text: plain, ...UNREAD });
      return;
    }
    readExpression(program.id, step, { value: value ?? null }).then(
      (read) => {
        if (mine === turn.current) setWritten({ text: read.text, read, refusal: null });
      },
      () => undefined,
    );
  }, [key, plain, value, program.id, step]);

  const keep = (next: Value) => {
    const nextKey = JSON.stringify(next);
    if (nextKey === known.current) return;
    known.current = nextKey;
    shared.visits.during(visit.current, () => change.current(next));
  };
  const store = async (text: string) => {
    const mine = ++turn.current;
    typing.current = false;
    const literal = readPlain(text, wanted);
    const read = literal ? UNREAD : await readLine(program.id, step, text);
    if (mine !== turn.current) return;
    setWritten((before) => ({ ...before, ...read }));
    if (literal) keep(literal.value);
    else if (read.read?.problem === null) keep(read.read.value);
  };
  const write = (text: string) => {
    turn.current += 1;
    typing.current = true;
    visit.current = shared.visits.now;
    setWritten((before) => ({ ...before, text }));
  };
  /** An answer that still comes is about what is taken back. */
  const forget = () => {
    turn.current += 1;
    typing.current = false;
  };
  return { written, write, store, forget };
}

/** What the server reads, or why it refused; silence leaves the line as it is. */
async function readLine(program: string, step: string, text: string): Promise<Omit<Written, "text">> {
  try {
    return { read: await readExpression(program, step, { text }), refusal: null };
  } catch (error) {
    return { read: null, refusal: error instanceof ApiProblem ? error.detail : null };
  }
}

/** An answer that comes late must meet the handler of the present document. */
function useLatest<T>(value: T) {
  const latest = useRef(value);
  useEffect(() => {
    latest.current = value;
  }, [value]);
  return latest;
}

export interface ExpressionProblem {
  readonly message: string;
  /** The message by language. */
  readonly messages: Readonly<Record<string, string>>;
  readonly column: number;
}

export interface ReadExpression {
  readonly value: Value;
  readonly text: string;
  readonly type: string;
  readonly unit: string;
  readonly problem: ExpressionProblem | null;
}

type Asked = { readonly text: string } | { readonly value: Value };

/** A text that stands for nothing comes back with its problem; only silence and refusals throw. */
export function readExpression(program: string, step: string, asked: Asked): Promise<ReadExpression> {
  return api.post<ReadExpression>(`/programs/${program}/expression`, { ...asked, step });
}
