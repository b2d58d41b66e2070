/** Another name and message for a version. */
import { notifications } from "@mantine/notifications";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { Program, Version } from "@/api/types";
import { useTellUnseen } from "@/shell/refusal";
import { VersionForm, type VersionWords } from "./VersionForm";

interface NameProps {
  version: Version;
  program: Program;
  onClose: () => void;
}

export function NameVersion({ version, program, onClose }: NameProps) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const rename = useMutation({
    mutationFn: (words: VersionWords) => api.patch(`/programs/${program.id}/versions/${version.number}`, words),
    onSuccess: () => {
      notifications.show({ message: t("history.renamed", { number: version.number }) });
      onClose();
      return queries.invalidateQueries({ queryKey: keys.versions(program.id) });
    },
    onError: useTellUnseen(),
  });
  return (
    <VersionForm
      title={t("history.rename")}
      known={version}
      busy={rename.isPending}
      error={rename.error}
      onSend={rename.mutate}
      onClose={onClose}
    />
  );
}
