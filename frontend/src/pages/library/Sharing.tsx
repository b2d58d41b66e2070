/** Who sees a function: chosen by its author and the admins of its site, told to everybody else. */
import { NativeSelect } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Globe, Lock, type LucideIcon, Users } from "lucide-react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { LibraryFunction } from "@/api/types";
import { VISIBILITIES, type Visibility } from "@/program/visibility";
import styles from "./library.module.css";

const SIGNS: Readonly<Record<Visibility, LucideIcon>> = { me: Lock, site: Users, everyone: Globe };

export function VisibilitySign({ item }: { item: LibraryFunction }) {
  const { t } = useTranslation();
  const Sign = SIGNS[item.visibility];
  const words = t(`library.visibility.${item.visibility}`);
  return (
    <span className={styles.sharing} title={words}>
      <Sign size={14} role="img" aria-label={words} />
    </span>
  );
}

export function Sharing({ item }: { item: LibraryFunction }) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const change = useMutation({
    mutationFn: (visibility: Visibility) => api.patch<LibraryFunction>(`/library/${item.id}`, { visibility }),
    onSuccess: async () => {
      await queries.invalidateQueries({ queryKey: keys.libraryFunction(item.id) });
      await queries.invalidateQueries({ queryKey: ["library"] });
    },
  });
  const label = t("library.visibleTo");
  if (!item.mine)
    return (
      <p className={styles.told}>
        {label}: {t(`library.visibility.${item.visibility}`)}
      </p>
    );
  return (
    <NativeSelect
      label={label}
      disabled={change.isPending}
      error={change.error?.message}
      value={item.visibility}
      data={VISIBILITIES.map((value) => ({ value, label: t(`library.visibility.${value}`) }))}
      onChange={(event) => change.mutate(event.currentTarget.value as Visibility)}
    />
  );
}
