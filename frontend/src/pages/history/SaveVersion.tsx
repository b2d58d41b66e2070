/** What is drawn now becomes a version, unless it is the last one already. */
import { Button } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Bookmark } from "lucide-react";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { Program, Version } from "@/api/types";
import { useTellUnseen } from "@/shell/refusal";
import { VersionForm, type VersionWords } from "./VersionForm";

function SaveForm({ program, onClose }: { program: Program; onClose: () => void }) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const save = useMutation({
    mutationFn: async (words: VersionWords) => {
      const before = await api.part<Version>(`/programs/${program.id}/versions?limit=1`);
      const made = await api.post<Version>(`/programs/${program.id}/versions`, words);
      return { made, isNew: made.number !== before.items[0]?.number };
    },
    onSuccess: ({ made, isNew }) => {
      onClose();
      notifications.show({ message: t(isNew ? "history.saved" : "history.unchanged", { number: made.number }) });
      return queries.invalidateQueries({ queryKey: keys.versions(program.id) });
    },
    onError: useTellUnseen(),
  });
  return (
    <VersionForm
      title={t("history.save_title")}
      busy={save.isPending}
      error={save.error}
      onSend={save.mutate}
      onClose={onClose}
    />
  );
}

export function SaveVersion({ program }: { program: Program }) {
  const { t } = useTranslation();
  const [opened, setOpened] = useState(false);
  return (
    <>
      <Button leftSection={<Bookmark size={16} aria-hidden="true" />} onClick={() => setOpened(true)}>
        {t("history.save")}
      </Button>
      {opened ? <SaveForm program={program} onClose={() => setOpened(false)} /> : null}
    </>
  );
}
