/** The library's functions, to be brought into this program and called at once. */
import { Button, Modal, TextInput } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { useMutation } from "@tanstack/react-query";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { useLibrary, useLibraryFunction } from "@/api/queries";
import type { LibraryFunction } from "@/api/types";
import { lackWords } from "@/program/words/libraryWords";
import { applyEdits } from "../edits/edits";
import { addStep } from "../edits/joints";
import { alreadyImported, importFunction } from "../edits/library";
import { branchNow, makeId } from "../state/actions";
import { freeSpot } from "../state/freeSpot";
import { useOpenProgram } from "../state/context";
import { say, select, useUi } from "../state/ui";
import { doAndSay } from "../state/undoing";
import { useAskedFunction } from "./askedFunction";
import { useScreenTexts } from "./screenTexts";
import classes from "./dialogs.module.css";

export function LibraryDialog() {
  const { t, canEdit } = useOpenProgram();
  const { asked, answered } = useAskedFunction(canEdit);
  const opened = useUi((ui) => ui.dialog === "library");
  const close = () => {
    useUi.setState({ dialog: null });
    answered();
  };
  return (
    <Modal opened={opened} onClose={close} title={t("library.title")} size="lg">
      {opened ? <Search asked={asked} onDone={close} /> : null}
    </Modal>
  );
}

/** What fits the typed words; until something is typed, only the function that was asked for, if any. */
function useFound(slug: string, query: string, asked: string | null) {
  const found = useLibrary(query, slug);
  const one = useLibraryFunction(asked ?? undefined, slug);
  const alone = asked && !query ? one.data : undefined;
  return {
    error: alone ? null : found.error,
    data: alone ? [alone] : found.data,
    more: !alone && found.hasNextPage ? () => void found.fetchNextPage() : null,
    isLoading: found.isFetchingNextPage,
  };
}

function Search({ asked, onDone }: { asked: string | null; onDone: () => void }) {
  const open = useOpenProgram();
  const { t } = open;
  const { t: words } = useTranslation();
  const texts = useScreenTexts();
  const [text, setText] = useState("");
  const [query] = useDebouncedValue(text, 200);
  const found = useFound(open.site.slug, query, asked);
  const fetching = useMutation({
    mutationFn: async (entry: LibraryFunction) => {
      const full = entry.definition ? entry : await api.get<LibraryFunction>(`/library/${entry.id}`);
      await keepVersion(open);
      return full;
    },
  });
  // What is told to `mutate` comes to nothing once the dialog has gone.
  const choose = (entry: LibraryFunction) =>
    fetching.mutate(entry, {
      onSuccess: (full) => {
        bringIn(open, full);
        onDone();
      },
      onError: (problem) => say(problem instanceof Error ? problem.message : t("library.failed")),
    });
  return (
    <div className={classes.content}>
      <TextInput
        label={t("library.search")}
        value={text}
        data-autofocus
        onChange={(event) => setText(event.currentTarget.value)}
      />
      {found.error ? <p className={classes.problem}>{found.error.message}</p> : null}
      {found.data?.length === 0 ? <p>{t("library.none")}</p> : null}
      <ul className={classes.functions}>
        {(found.data ?? []).map((entry) => (
          <li key={entry.id}>
            <button
              type="button"
              className={classes.function}
              disabled={fetching.isPending}
              onClick={() => choose(entry)}
            >
              <strong>{`${entry.name} v${entry.version}`}</strong>
              {entry.site === open.site.slug ? null : <span>{t("library.of_site", { site: entry.site })}</span>}
              <span>{entry.description || entry.parameters.map((each) => each.name).join(", ")}</span>
              {texts && entry.lacks?.length ? <em>{lackWords(words, entry.lacks)}</em> : null}
            </button>
          </li>
        ))}
      </ul>
      {found.more ? (
        <Button variant="default" loading={found.isLoading} onClick={found.more}>
          {t("library.more")}
        </Button>
      ) : null}
    </div>
  );
}

/** What is there before something is brought in is kept as a version, with all that stands on this screen. */
async function keepVersion({ shared, program }: ReturnType<typeof useOpenProgram>): Promise<void> {
  await shared.stored();
  await api.post(`/programs/${program.id}/versions`, { cause: "import" });
}

/** One entry to undo: the definition, its steps and the call. */
function bringIn(open: ReturnType<typeof useOpenProgram>, entry: LibraryFunction): void {
  const { shared, apply, t } = open;
  const document = shared.getDocument();
  const known = alreadyImported(document, entry.id, entry.version);
  const source = { library: entry.id, version: entry.version };
  const fresh = known ? null : importFunction(document, entry.definition, source, makeId);
  const functionId = known ?? fresh?.functionId ?? "";
  const before = fresh?.edits ?? [];
  const callId = makeId();
  const after = applyEdits(document, before);
  const params = { function: functionId, args: {} };
  const call = addStep(after, branchNow(document), { id: callId, kind: "call", pos: freeSpot(open), params });
  doAndSay(
    open,
    () => apply([...before, ...call]),
    () => t("library.imported", { name: entry.name }),
  );
  select([callId]);
}
